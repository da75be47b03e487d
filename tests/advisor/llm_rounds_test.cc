#include "advisor/llm_rounds.h"

#include <deque>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/route_cost.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kGood = "No. [(5, 60), (70, 28), (90, 28), (155, 60)]";
constexpr const char* kSame = "No. [(5, 60), (155, 60)]";
constexpr const char* kBlocked = "No. [(5, 60), (5, 118), (155, 60)]";

// Answers one after the other, and then no more.
class Script : public LlmClient {
 public:
  explicit Script(std::deque<std::string> answers)
      : answers_(std::move(answers)) {}
  const LlmIdentity& identity() const override { return identity_; }
  LlmReply Ask(const LlmRequest& request, std::stop_token) override {
    questions.push_back(request.text);
    LlmReply reply;
    reply.tries = 1;
    reply.t_llm_s = 10;
    if (answers_.empty()) {
      reply.reason = NoAnswer::kTransport;
      return reply;
    }
    reply.status = ReplyStatus::kAnswered;
    reply.text = answers_.front();
    reply.usage = {1'000, 20, 5};
    reply.spend_usd = 0.25;
    answers_.pop_front();
    return reply;
  }

  std::vector<std::string> questions;

 private:
  std::deque<std::string> answers_;
  LlmIdentity identity_{"chat", "m", "{}", "loopback"};
};

// A costly bar between start and goal, open at the top; obstacle at the bottom.
struct Problem {
  TerrainMap map = [] {
    ByteRaster ids = ByteRaster::Zero(120, 160);
    ids.block(30, 70, 80, 20).setConstant(10);
    ids.block(110, 0, 10, 160).setConstant(11);
    return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  }();
  Route baseline = {{5, 60}, {155, 60}};
  double cost = WalkRoute(map, baseline).cost;

  PlanningCase planning_case() const {
    return {"case", map, baseline.front(), baseline.back(), baseline, cost, ""};
  }
  AskedCase Ask(Script& script, MethodOptions options) const {
    return AskInRounds(planning_case(), options,
                       PrepareCase(planning_case(), options, nullptr).request,
                       script, {});
  }
};

MethodOptions Rounds(int rounds) {
  MethodOptions options;
  options.rounds = rounds;
  return options;
}

TEST(LlmRounds, ThePapersOneRoundAsksOnce) {
  Script script({kSame, kGood});
  const AskedCase asked = Problem().Ask(script, Rounds(1));
  EXPECT_EQ(script.questions.size(), 1u);
  EXPECT_EQ(asked.reply.text, kSame);
}

TEST(LlmRounds, ARejectedProposalIsAskedForAgainWithItsVerdict) {
  Script script({kBlocked, kSame, kGood, "never"});
  const AskedCase asked = Problem().Ask(script, Rounds(5));
  ASSERT_EQ(script.questions.size(), 3u);
  EXPECT_TRUE(script.questions[1].starts_with(script.questions[0]));
  EXPECT_THAT(script.questions[1], HasSubstr(kBlocked));
  EXPECT_THAT(script.questions[1], HasSubstr("obstacle at (5, 110)"));
  EXPECT_THAT(script.questions[2], HasSubstr("not less than the baseline"));
  EXPECT_THAT(script.questions[2], Not(HasSubstr(kBlocked)));
  EXPECT_EQ(asked.reply.text, kGood);
  EXPECT_EQ(asked.rounds, 3);
  EXPECT_EQ(asked.reply.tries, 3);
  EXPECT_EQ(asked.reply.t_llm_s, 30);
  EXPECT_EQ(asked.reply.usage.tokens_in, 3'000);
  EXPECT_EQ(asked.reply.spend_usd, 0.75);
}

TEST(LlmRounds, RetentionsAndMalformedAnswersAreFinal) {
  for (const char* answer : {"Yes", "No", "What a nice map!", ""}) {
    Script script({answer, kGood});
    EXPECT_EQ(Problem().Ask(script, Rounds(5)).reply.text, answer);
    EXPECT_EQ(script.questions.size(), 1u) << answer;
  }
}

TEST(LlmRounds, WhenALaterRoundFailsTheOneBeforeCounts) {
  Script script({kSame});
  const AskedCase asked = Problem().Ask(script, Rounds(5));
  EXPECT_EQ(asked.reply.text, kSame);
  EXPECT_EQ(asked.outcome.kind, AnswerKind::kPropose);
  EXPECT_EQ(asked.rounds, 1);
  EXPECT_EQ(asked.reply.tries, 2) << "it is paid for all the same";
}

TEST(LlmRounds, NoRoundBeginsThatWouldPassTheDeadline) {
  MethodOptions options = Rounds(5);
  options.rounds_deadline_s = 25;
  Script script({kSame, kSame, kGood});
  EXPECT_EQ(Problem().Ask(script, options).rounds, 2);
}

TEST(LlmRounds, TheVerdictSaysWhatIsWrong) {
  const Problem problem;
  const auto verdict = [&](const Route& route) {
    return VerdictForModel(problem.planning_case(), {}, {route, ""});
  };
  EXPECT_THAT(verdict({{5, 60}, {70, 28}, {90, 28}, {155, 60}}), IsEmpty());
  EXPECT_THAT(verdict({{5, 60}}), HasSubstr("fewer than two"));
  EXPECT_THAT(verdict({{6, 60}, {155, 60}}), HasSubstr("not at the start"));
  EXPECT_THAT(verdict({{5, 60}, {154, 60}}), HasSubstr("not at the goal"));
  EXPECT_THAT(verdict({{5, 60}, {5, -9}, {155, 60}}),
              HasSubstr("leaves the map"));
  EXPECT_THAT(
      VerdictForModel(problem.planning_case(), {}, {{}, "target_outside"}),
      HasSubstr("target_outside"));
}

TEST(LlmRounds, NoVerdictTellsOfABaselineThatTheQuestionDoesNotTell) {
  const Problem problem;
  const OutcomeCandidate same{problem.baseline, ""};
  MethodOptions options;
  options.prompt.route_text = false;
  EXPECT_THAT(VerdictForModel(problem.planning_case(), options, same),
              Not(HasSubstr("which costs")));
  options.method = Method::kDirect;
  EXPECT_THAT(VerdictForModel(problem.planning_case(), options, same),
              IsEmpty());
}

}  // namespace
}  // namespace terra::advisor

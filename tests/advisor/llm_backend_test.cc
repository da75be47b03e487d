#include "advisor/llm_backend.h"

#include <cstdlib>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/recording_clients.h"
#include "terrain/files/whole_file.h"
#include "terrain/route_cost.h"
#include "tests/support/bar_map.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/support/temp_folder.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using testing::kCheaperAnswer;
using ::testing::Not;
using testing::ReplyBody;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;
using testing::TempFolder;

ScriptedReply Saying(const std::string& text) {
  ScriptedReply reply;
  reply.body = ReplyBody("chat", text);
  return reply;
}

// A costly bar, and a straight baseline across it.
struct Problem {
  TerrainMap map = testing::BarMap();
  Route baseline = {testing::kBarStart, testing::kBarGoal};
  double cost = WalkRoute(map, baseline).cost;

  AdviceTask task() const {
    return {map, 77, 1, baseline.front(), baseline.back(), baseline, cost};
  }
};

LlmBackendOptions ChatOptions(const std::string& url) {
  LlmBackendOptions options;
  options.service.backend = "chat";
  options.service.provider.base_url = url;
  options.service.provider.deadline_s = 10;
  options.service.provider.retry.max_retries = 0;
  return options;
}

std::unique_ptr<Backend> Make(const LlmBackendOptions& options) {
  auto made = LlmBackend::Create(options);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
  return *std::move(made);
}

TEST(LlmBackendTest, ProposesWhatTheModelAnswered) {
  const Problem problem;
  ScriptedLlmServer server({Saying(kCheaperAnswer)});
  const auto backend = Make(ChatOptions(server.url()));
  const AdviceAnswer answer = backend->Advise(problem.task(), {});
  ASSERT_EQ(answer.kind, AnswerKind::kPropose) << answer.error;
  EXPECT_EQ(answer.form, AnswerForm::kExact);
  ASSERT_EQ(answer.candidates.size(), 1u);
  EXPECT_EQ(answer.candidates[0].route,
            (Route{{5, 60}, {70, 28}, {90, 28}, {155, 60}}));
  EXPECT_EQ(answer.answer_text, kCheaperAnswer);
  EXPECT_EQ(answer.model, "scripted");
  EXPECT_EQ(answer.tokens_in, 1000);
  EXPECT_EQ(answer.request_hash.size(), 32u);
}

TEST(LlmBackendTest, OnlyACanonicalYesRetains) {
  const Problem problem;
  for (const char* yes :
       {"Yes", " yes.\n", "**Yes**", "```\nYES\n```", "\"Yes.\""}) {
    ScriptedLlmServer server({Saying(yes)});
    EXPECT_EQ(Make(ChatOptions(server.url()))->Advise(problem.task(), {}).kind,
              AnswerKind::kRetain)
        << yes;
  }
  for (const char* other :
       {"Yes, because it is short", "Yes [(5, 60), (155, 60)]", "No", "", "Ja",
        "Yes..", "Yes or No"}) {
    ScriptedLlmServer server({Saying(other)});
    EXPECT_EQ(Make(ChatOptions(server.url()))->Advise(problem.task(), {}).kind,
              AnswerKind::kMalformed)
        << other;
  }
}

TEST(LlmBackendTest, ARecordingReplaysBitForBitWithoutNetwork) {
  const Problem problem;
  const TempFolder folder;
  const std::string recording = folder.Path("calls.jsonl");
  AdviceAnswer first;
  {
    ScriptedLlmServer server(
        {Saying("No. [(5, 60), (80, 20), (155, 60)] caf\u00e9")});
    LlmBackendOptions options = ChatOptions(server.url());
    options.service.record = recording;
    first = Make(options)->Advise(problem.task(), {});
  }
  LlmBackendOptions replay;
  replay.service.backend = "replay";
  replay.service.recording = recording;
  const AdviceAnswer second = Make(replay)->Advise(problem.task(), {});
  EXPECT_EQ(second.kind, first.kind);
  EXPECT_EQ(second.answer_text, first.answer_text);
  EXPECT_EQ(second.request_hash, first.request_hash);
  EXPECT_EQ(second.model, first.model);
  EXPECT_EQ(second.tokens_in, first.tokens_in);
  EXPECT_EQ(second.t_llm_us, first.t_llm_us);
  ASSERT_EQ(second.candidates.size(), first.candidates.size());

  LlmBackendOptions other = replay;
  other.method.prompt.route_text = false;
  const AdviceAnswer unknown = Make(other)->Advise(problem.task(), {});
  EXPECT_EQ(unknown.kind, AnswerKind::kFailed);
  EXPECT_THAT(unknown.error, HasSubstr("not_recorded"));
}

TEST(LlmBackendTest, TheKeyReachesTheServerAndNothingElse) {
  constexpr const char* kSecret = "sk-secret-0123456789";
  const Problem problem;
  const TempFolder folder;
  const std::string recording = folder.Path("calls.jsonl");
  setenv("OPENAI_API_KEY", kSecret, 1);
  ScriptedReply denied;
  denied.status = 401;
  denied.body =
      std::string(R"({"error":{"message":"Incorrect API key provided: )") +
      kSecret + "\"}}";
  ScriptedReply echo;
  echo.body = ReplyBody("openai", std::string("No. my key is ") + kSecret);
  ScriptedLlmServer server({denied, echo});
  LlmBackendOptions options = ChatOptions(server.url());
  options.service.backend = "openai";
  options.service.record = recording;
  const auto backend = Make(options);
  unsetenv("OPENAI_API_KEY");
  std::string seen;
  for (int call = 0; call < 2; ++call) {
    const AdviceAnswer answer = backend->Advise(problem.task(), {});
    seen += answer.error + answer.answer_text + answer.model;
  }
  seen += ReadWholeFile(recording, 1u << 20).value();
  EXPECT_THAT(seen, HasSubstr("[key]"));
  EXPECT_THAT(seen, Not(HasSubstr(kSecret)));
  EXPECT_EQ(server.requests().front().Header("authorization"),
            std::string("Bearer ") + kSecret);
}

TEST(LlmBackendTest, NobodyIsAskedWhereTooLittleCanBeGained) {
  const Problem problem;
  ScriptedLlmServer server({Saying(kCheaperAnswer)});
  LlmBackendOptions options = ChatOptions(server.url());
  options.min_gain_percent = 90;
  EXPECT_EQ(Make(options)->Advise(problem.task(), {}).kind,
            AnswerKind::kFailed);
  EXPECT_EQ(server.request_count(), 0);
  options.min_gain_percent = 20;
  EXPECT_EQ(Make(options)->Advise(problem.task(), {}).kind,
            AnswerKind::kPropose);
}

TEST(LlmBackendTest, FailuresInSuccessionOpenTheBreaker) {
  const Problem problem;
  ScriptedReply failing;
  failing.status = 400;
  ScriptedLlmServer server({failing});
  LlmBackendOptions options = ChatOptions(server.url());
  options.service.limits.breaker_failures = 3;
  const auto backend = Make(options);
  for (int call = 0; call < 5; ++call) backend->Advise(problem.task(), {});
  EXPECT_EQ(server.request_count(), 3);
  EXPECT_EQ(backend->figures().state, "failing: breaker open");
  EXPECT_THAT(backend->Advise(problem.task(), {}).error,
              HasSubstr("breaker_open: calls pause after --breaker-failures"));
}

TEST(LlmBackendTest, ALimitThatIsReachedIsNamed) {
  const Problem problem;
  ScriptedLlmServer server({Saying("Yes")});
  LlmBackendOptions often = ChatOptions(server.url());
  often.service.limits.calls_per_minute = 1;
  LlmBackendOptions dear = ChatOptions(server.url());
  dear.service.prices = {"local-model=1000:1000"};
  dear.service.limits.spend_per_hour_usd = 0.5;
  for (const auto& [options, limit] :
       {std::pair<LlmBackendOptions, std::string>{
            often, "rate_limit: --calls-per-minute is reached"},
        {dear, "spend_limit: --spend-per-hour is reached"}}) {
    const auto backend = Make(options);
    EXPECT_EQ(backend->Advise(problem.task(), {}).kind, AnswerKind::kRetain);
    const AdviceAnswer refused = backend->Advise(problem.task(), {});
    EXPECT_EQ(refused.kind, AnswerKind::kFailed);
    EXPECT_THAT(refused.error, HasSubstr(limit));
  }
  EXPECT_EQ(server.request_count(), 2);
}

TEST(LlmBackendTest, TargetsOfLlmAstarAreJoinedByTheNativeSearch) {
  const Problem problem;
  ScriptedLlmServer server({Saying("[(80, 20)]")});
  LlmBackendOptions options = ChatOptions(server.url());
  options.method.method = Method::kLlmAstar;
  const AdviceAnswer answer = Make(options)->Advise(problem.task(), {});
  ASSERT_EQ(answer.candidates.size(), 1u) << answer.error;
  const Route& route = answer.candidates[0].route;
  EXPECT_EQ(route.front(), problem.baseline.front());
  EXPECT_EQ(route.back(), problem.baseline.back());
  EXPECT_LT(WalkRoute(problem.map, route).cost, problem.cost);
  EXPECT_LT(route.size(), 20u) << "straight runs need no waypoints";
}

// The question must not change by accident: recordings are filed under it. A
// change of the wording changes these on purpose, and is listed as such.
TEST(LlmBackendTest, AQuestionHasTheSameHashOnEveryMachine) {
  const Problem problem;
  const PlanningCase planning_case{"case",
                                   problem.map,
                                   problem.baseline.front(),
                                   problem.baseline.back(),
                                   problem.baseline,
                                   problem.cost,
                                   ""};
  const PreparedCase prepared =
      PrepareCase(planning_case, {}, &ReferencePool::Builtin());
  const LlmIdentity identity{"openai", "gpt-5.5", "{}", "provider"};
  EXPECT_EQ(RequestHash(identity, prepared.request),
            "8009723e0edb6bd3e7ba8464b0d4e4e6");
  EXPECT_EQ(PromptId(), "35bdd893257b");
}

}  // namespace
}  // namespace terra::advisor

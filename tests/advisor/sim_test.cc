// The simulated model: it finds in a question what a model is shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "advisor/answer_parser.h"
#include "advisor/llm_methods.h"
#include "advisor/sim_answer.h"
#include "advisor/sim_wire.h"
#include "advisor/wire_format.h"
#include "terrain/builtin_legends.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "tests/advisor/golden_question.h"

namespace terra::advisor {
namespace {

// A costly bar between start and goal, open at the top.
TerrainMap BarMap(int scale) {
  ByteRaster ids = ByteRaster::Zero(120 * scale, 160 * scale);
  ids.block(30 * scale, 70 * scale, 90 * scale, 20 * scale).setConstant(10);
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

struct Asked {
  TerrainMap map;
  Route baseline;
  double cost = 0;
  std::string answer;
};

Asked Ask(int scale, const MethodOptions& options, bool optimal_baseline) {
  Asked asked{BarMap(scale), {}, 0, ""};
  const Cell start{30 * scale, 60 * scale};
  const Cell goal{130 * scale, 60 * scale};
  asked.baseline = optimal_baseline ? NativeSearch(asked.map, start, goal).cells
                                    : Route{start, goal};
  asked.cost = WalkRoute(asked.map, asked.baseline).cost;
  const PreparedCase prepared = PrepareCase(
      {"case", asked.map, start, goal, asked.baseline, asked.cost, ""}, options,
      &ReferencePool::Builtin());
  asked.answer = SimulatedAnswer(prepared.request.text,
                                 prepared.request.pictures.front()->png);
  return asked;
}

TEST(SimulatedAnswer, IsACheaperRouteInTheFormAskedFor) {
  for (const bool axes : {false, true}) {
    MethodOptions options;
    options.prompt.axes = axes;
    const Asked asked = Ask(1, options, false);
    const Answer answer = ParseAnswer(asked.answer, {});
    ASSERT_EQ(answer.kind, AnswerKind::kPropose) << asked.answer;
    EXPECT_EQ(answer.form, AnswerForm::kExact);
    EXPECT_LT(WalkRoute(asked.map, answer.candidates[0].waypoints).cost,
              asked.cost);
  }
}

TEST(SimulatedAnswer, IsYesWhereTheBaselineIsTheBestThatItSees) {
  EXPECT_EQ(Ask(1, {}, true).answer, "Yes");
}

TEST(SimulatedAnswer, IsARouteWithoutYesOrNoWhereThatIsAskedFor) {
  MethodOptions options;
  options.method = Method::kDirect;
  EXPECT_TRUE(Ask(1, options, true).answer.starts_with("[("));
}

TEST(SimulatedAnswer, IsFoundOnAReducedPictureToo) {
  const Asked asked = Ask(11, {}, false);  // 1760 cells wide: 2 to a pixel.
  EXPECT_EQ(ParseAnswer(asked.answer, {}).kind, AnswerKind::kPropose)
      << asked.answer;
}

TEST(SimulatedAnswer, SaysSoWhereThereIsNothingToRead) {
  for (const char* text : {"", "What is this?",
                           "The map has x from 0 to 99999999, y from 0 to 5\n"
                           "Start: (0, 0)\nGoal: (1, 1)\n"}) {
    EXPECT_EQ(SimulatedAnswer(text, "no picture"),
              "I cannot read this question.");
  }
}

class SimulatedWire : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, SimulatedWire,
                         ::testing::Values("openai", "gemini", "anthropic",
                                           "chat"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(SimulatedWire, ReadsWhatAClientOfThatFormSends) {
  const auto format = MakeWireFormat(GetParam());
  GenerationSettings settings;
  settings.model = "m";
  const LlmRequest request = GoldenQuestion("question");
  const auto question = ReadWireQuestion(
      format->Path(settings), format->Body(request, settings).dump());
  ASSERT_TRUE(question);
  EXPECT_EQ(question->provider, GetParam());
  EXPECT_EQ(question->text, "question\n");
  ASSERT_EQ(question->pngs.size(), 3u);
  EXPECT_EQ(question->pngs[1], request.pictures[1]->png);
}

TEST_P(SimulatedWire, RepliesInAFormThatItsClientReads) {
  const WireReply reply =
      MakeWireFormat(GetParam())
          ->ReadReply(WriteWireReply(GetParam(), "terra-llm-sim",
                                     "No. [(1, 2), (3, 4)]"));
  EXPECT_EQ(reply.status, ReplyStatus::kAnswered) << reply.error;
  EXPECT_EQ(reply.text, "No. [(1, 2), (3, 4)]");
  EXPECT_EQ(reply.model, "terra-llm-sim");
}

TEST_P(SimulatedWire, AnyOtherBodyIsNoQuestion) {
  GenerationSettings settings;
  settings.model = "m";
  const std::string path = MakeWireFormat(GetParam())->Path(settings);
  for (const char* body :
       {"", "{", "[]", "null", "{}", "\xff", R"({"messages":1})",
        R"({"messages":[{"content":[{"text":5}]}]})",
        R"({"input":[{"content":[{"image_url":{}}]}]})",
        R"({"contents":[{"parts":[{"inlineData":{}}]}]})"}) {
    EXPECT_FALSE(ReadWireQuestion(path, body)) << body;
  }
}

}  // namespace
}  // namespace terra::advisor

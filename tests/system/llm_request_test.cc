// Who asks for a route learns why a model had no answer, and does not wait for
// one that cannot come.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/bar_map.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class RequestToAModel : public ::testing::Test {
 protected:
  void StartAround(const std::string& base_url) {
    robot_.Start("map");
    robot_.Start("planner", {"--stride", "20"});
    robot_.Start("verifier");
    model_ =
        &robot_.Start("model", {"--backend", "openai", "--base-url", base_url});
    ASSERT_TRUE(robot_.WaitForReady("model"));
  }

  testing::RunResult Request(const std::vector<std::string>& more = {}) {
    const auto bus = robot_.BusOptions();
    std::vector<std::string> request = {
        testing::ProgramPath("terra"),
        "request",
        bus.at(0),
        bus.at(1),
        "--start",
        "5,60",
        "--goal",
        "155,60",
        "--wait",
        "3600"};  // Longer than the test may take.
    request.insert(request.end(), more.begin(), more.end());
    return testing::RunToEnd(request);
  }

  // First: it may move to a network of its own.
  testing::Robot robot_{testing::BarMap()};
  testing::ChildProcess* model_ = nullptr;
};

TEST_F(RequestToAModel, EndsWithTheReasonWhenTheCallFailed) {
  testing::ScriptedReply missing;
  missing.status = 404;
  missing.body = testing::ErrorBody("openai", "no such model");
  testing::ScriptedLlmServer server({missing});
  ASSERT_NO_FATAL_FAILURE(StartAround(server.url()));
  const auto said = Request();
  EXPECT_EQ(said.exit_code, 0) << "the baseline is there";
  EXPECT_THAT(said.output, HasSubstr("no advisor had an answer"));
  EXPECT_THAT(said.output, HasSubstr("HTTP 404: no such model"));
  EXPECT_THAT(said.output, HasSubstr("check --base-url"));

  const auto needed = Request({"--need-advice"});
  EXPECT_EQ(needed.exit_code, 3);
  EXPECT_THAT(needed.output, HasSubstr("no advice came; the baseline is "
                                       "deployed"));
}

TEST_F(RequestToAModel, AnyAnswerThatTheGateJudgedIsAdvice) {
  std::vector<testing::ScriptedReply> script(3);
  const char* answers[] = {testing::kCheaperAnswer, "Yes", "What a nice map!"};
  for (std::size_t i = 0; i < script.size(); ++i) {
    script[i].body = testing::ReplyBody("openai", answers[i]);
  }
  testing::ScriptedLlmServer server(script);
  ASSERT_NO_FATAL_FAILURE(StartAround(server.url()));
  for (const char* verdict : {"accepted", "retained", "parse_error"}) {
    const auto said = Request({"--need-advice"});
    EXPECT_EQ(said.exit_code, 0) << said.output;
    EXPECT_THAT(said.output, Not(HasSubstr("no advice came")));
    if (std::string(verdict) != "accepted") {
      EXPECT_THAT(said.output, HasSubstr(verdict));
    }
  }
  EXPECT_THAT(Request().output, HasSubstr("; no_list"))
      << "why it could not be read";
  EXPECT_THAT(model_->output(), HasSubstr("SIMULATED"))
      << "said at the start of whoever answers on this machine";
}

TEST_F(RequestToAModel, WhatACallCostsIsSaidWithoutTheBusToo) {
  testing::ScriptedReply yes;  // 1,000 tokens in, 20 out.
  yes.body = testing::ReplyBody("openai", "Yes");
  testing::ScriptedLlmServer server({yes});
  std::vector<std::string> advise = {testing::ProgramPath("terra"),
                                     "advise",
                                     "--map",
                                     robot_.map_path(),
                                     "--start",
                                     "5,60",
                                     "--goal",
                                     "155,60",
                                     "--stride",
                                     "20",
                                     "--backend",
                                     "openai",
                                     "--base-url",
                                     server.url(),
                                     "--price",
                                     "gpt-5.5=10:500"};
  const auto said = testing::RunToEnd(advise);
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_THAT(said.output, HasSubstr("1000 tokens in, 20 out, $0.0200"));
  advise.push_back("--json");
  EXPECT_THAT(testing::RunToEnd(advise).output,
              HasSubstr("\"spend_usd\":0.02"));
}

}  // namespace
}  // namespace terra

// Who asks for a route learns why a model had no answer, and does not wait for
// one that cannot come.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scripted_llm_server.h"
#include "tests/system/bar_map.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using ::testing::HasSubstr;

TEST(RequestToAModel, EndsWithTheReasonWhenTheCallFailed) {
  // First: it may move to a network of its own.
  testing::Robot robot{testing::BarMap()};
  testing::ScriptedReply missing;
  missing.status = 404;
  missing.body = testing::ErrorBody("openai", "no such model");
  testing::ScriptedLlmServer server({missing});
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
  robot.Start("model", {"--backend", "openai", "--base-url", server.url()});
  ASSERT_TRUE(robot.WaitForReady("model"));
  const auto bus = robot.BusOptions();
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
  const auto said = testing::RunToEnd(request);
  EXPECT_EQ(said.exit_code, 0) << "the baseline is there";
  EXPECT_THAT(said.output, HasSubstr("no advisor had an answer"));
  EXPECT_THAT(said.output, HasSubstr("HTTP 404: no such model"));
  EXPECT_THAT(said.output, HasSubstr("check --base-url"));
}

}  // namespace
}  // namespace terra

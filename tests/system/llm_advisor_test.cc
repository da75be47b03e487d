// The LLM advisor as a process, beside the deployed path as processes.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::status_t;
using testing::ReplyBody;
using testing::Robot;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

constexpr Cell kStart = {5, 60};
constexpr Cell kGoal = {155, 60};
constexpr const char* kCheaper = "No. [(5, 60), (70, 28), (90, 28), (155, 60)]";

// Ground with a costly bar between start and goal, open at the top.
TerrainMap BarMap() {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(10);
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

void StartDeployedPath(Robot& robot) {
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
}

std::vector<std::string> ChatOptions(const ScriptedLlmServer& server,
                                     const std::string& deadline_s) {
  return {"--backend",  "chat",     "--base-url",         server.url(),
          "--deadline", deadline_s, "--breaker-failures", "0",
          "--retries",  "0"};
}

ScriptedReply Saying(const std::string& text) {
  ScriptedReply reply;
  reply.body = ReplyBody("chat", text);
  return reply;
}

TEST(LlmAdvisor, ANewRequestEndsTheCallForTheOldOneAtOnce) {
  Robot robot(BarMap());
  ScriptedReply silent;
  silent.silent = true;
  ScriptedLlmServer server({silent, Saying(kCheaper)});
  StartDeployedPath(robot);
  robot.Start("model", ChatOptions(server, "600"));
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  ASSERT_TRUE(server.WaitForRequests(1, 20));
  ASSERT_TRUE(robot.Ask(12, kStart, kGoal));
  EXPECT_TRUE(robot.WaitForDeployed(12, deployed_t::MODE_CANDIDATE))
      << "the call for request 11 would hang for ten minutes";
  for (const advice_t& advice : robot.advice_bus().Heard<advice_t>()) {
    EXPECT_EQ(advice.request_id, 12);
  }
}

TEST(LlmAdvisor, HeartbeatTellsCallsTokensAndLatency) {
  Robot robot(BarMap());
  ScriptedLlmServer server({Saying(kCheaper)});
  StartDeployedPath(robot);
  robot.Start("model", ChatOptions(server, "10"));
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  const auto status =
      robot.deployed_bus().WaitFor<status_t>([](const status_t& message) {
        if (message.status_name != "model") return false;
        bool called = false;
        bool tokens = false;
        bool latency = false;
        for (std::size_t i = 0; i < message.counter_name.size(); ++i) {
          const std::string& name = message.counter_name[i];
          called |= name == "llm_calls" && message.counter_value[i] == 1;
          tokens |= name == "tokens_in" && message.counter_value[i] == 1000;
          latency |= name == "llm_p95_ms";
        }
        return called && tokens && latency;
      });
  EXPECT_TRUE(status);
}

TEST(LlmAdvisor, AMissingKeyIsSaidAtTheStart) {
  Robot robot(BarMap());
  testing::ChildProcess& advisor =
      robot.Start("model", {"--backend", "anthropic"});
  EXPECT_EQ(advisor.WaitForExit(testing::BusPeer::kPatience), 1);
  EXPECT_NE(advisor.output().find("ANTHROPIC_API_KEY"), std::string::npos);
}

}  // namespace
}  // namespace terra

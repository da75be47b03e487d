#include "cli/monitor_node.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/wire.h"

namespace terra::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class MonitorNodeTest : public ::testing::Test {
 protected:
  /// What is shown after a heartbeat.
  std::string ViewAfter(const terra_msg::status_t& status) {
    node_.Receive({bus::Channel::kStatus, bus::Encode(status)}, now_);
    return node_.View(now_);
  }

  bus::Time now_ = bus::Time{} + std::chrono::seconds(10);
  MonitorNode node_{std::chrono::hours(1), [](const std::string&) {
                      return true;
                    }};
};

terra_msg::status_t Heartbeat(const std::string& name, const bus::Counters& c) {
  terra_msg::status_t status{};
  status.utime = 1;
  status.session = 1;
  status.seq = 1;
  status.status_name = name;
  status.host = "h";
  status.pid = 7;
  status.state = "ready";
  for (const auto& [counter, value] : c) {
    status.counter_name.push_back(counter);
    status.counter_value.push_back(value);
  }
  status.num_counters = static_cast<std::int32_t>(c.size());
  return status;
}

TEST_F(MonitorNodeTest, TellsWhatTheCallsToAModelCameTo) {
  const std::string view =
      ViewAfter(Heartbeat("model", {{"jobs", 4},
                                    {"queue", 1},
                                    {"llm_calls", 3},
                                    {"llm_no_answer", 1},
                                    {"llm_skipped", 2},
                                    {"llm_p50_ms", 400},
                                    {"llm_p95_ms", 900},
                                    {"tokens_in", 12'000},
                                    {"tokens_out", 60},
                                    {"spend_micro_usd", 123'400},
                                    {"spend_hour_micro_usd", 23'400}}));
  EXPECT_THAT(view, HasSubstr("3 calls (1 without answer, 2 skipped), 1 "
                              "running, p50 400 ms, p95 900 ms"));
  EXPECT_THAT(view, HasSubstr("12000 tokens in, 60 out, $0.1234, in the last "
                              "hour $0.0234"));
}

TEST_F(MonitorNodeTest, SaysNothingOfCallsWhereThereAreNone) {
  const std::string view = ViewAfter(Heartbeat("search", {{"jobs", 4}}));
  EXPECT_THAT(view, HasSubstr("search"));
  EXPECT_THAT(view, Not(HasSubstr("calls")));
}

terra_msg::deployed_t CandidateOf(const std::string& advisor) {
  terra_msg::deployed_t deployed{};
  deployed.utime = 1;
  deployed.session = 5;
  deployed.seq = 1;
  deployed.decision = 3;
  deployed.route_seq = 2;
  deployed.request_id = 11;
  deployed.goal_x = 4;
  deployed.mode = terra_msg::deployed_t::MODE_CANDIDATE;
  deployed.cause = terra_msg::deployed_t::CAUSE_UPGRADE;
  deployed.source = advisor;
  deployed.source_attempt = 7;
  deployed.num_waypoints = 2;
  deployed.waypoint_x = {0, 4};
  deployed.waypoint_y = {0, 0};
  deployed.num_steps = 4;
  deployed.num_chain_bytes = 2;
  deployed.chain = {0, 0};
  deployed.deployed_cost = 498.125;
  deployed.baseline_cost = 693;
  return deployed;
}

TEST_F(MonitorNodeTest, TellsOfVerdictsFromBeforeItBeganWhatIsRepeated) {
  EXPECT_THAT(node_.View(now_), HasSubstr("none heard since this view began"));
  node_.Receive({bus::Channel::kDeployed, bus::Encode(CandidateOf("search"))},
                now_);
  const std::string view =
      ViewAfter(Heartbeat("verifier", {{"judged", 9}, {"accepted", 2}}));
  EXPECT_THAT(view, HasSubstr("search               accepted before this view "
                              "began: attempt 7, cost 498.125"));
  EXPECT_THAT(view, HasSubstr("verifier has judged 9 since its start and "
                              "accepted 2"));
  EXPECT_THAT(view, Not(HasSubstr("none heard since")));
}

TEST(MonitorNode, EndsWhenNobodySeesIt) {
  MonitorNode node(std::chrono::hours(1), [](const std::string&) {
    return false;
  });
  bus::Time now = bus::Time{} + std::chrono::seconds(10);
  for (int i = 0; i < 3 && !node.done(); ++i) now = node.Advance(now);
  EXPECT_TRUE(node.done());
}

}  // namespace
}  // namespace terra::cli

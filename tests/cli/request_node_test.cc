#include "cli/request_node.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/request_report.h"

namespace terra::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::int64_t kRequest = 5;
constexpr std::int64_t kOldMap = 100;
constexpr std::int64_t kNewMap = 200;

// A request for a route, and what a set says to it.
class RequestNodeTest : public ::testing::Test, public bus::Transport {
 protected:
  bool Publish(bus::Channel, std::span<const std::uint8_t>) override {
    return true;
  }

  void Ask(bus::Duration wait) {
    RequestPlan plan;
    plan.request_id = kRequest;
    plan.wait = wait;
    node_.emplace(plan, out_);
    node_->Advance(now_);
  }

  template <typename T>
  void Hear(T message) {
    message.session = 7;
    message.seq = ++seq_;
    node_->Receive({bus::MessageTraits<T>::kChannel, bus::Encode(message)},
                   now_);
    node_->Advance(now_);
  }
  void Offer(std::int64_t map_id) {
    terra_msg::map_header_t header{};
    header.map_id = map_id;
    Hear(header);
  }
  void Baseline(std::int8_t status, std::int64_t map_id) {
    baseline_t message{};
    message.request_id = kRequest;
    message.status = status;
    message.map_id = map_id;
    Hear(message);
  }
  void Deployed(std::int8_t mode, std::int64_t map_id) {
    deployed_t message{};
    message.request_id = kRequest;
    message.mode = mode;
    message.map_id = map_id;
    Hear(message);
  }

  // Whether it has ended after so long.
  bool EndsWithin(bus::Duration at_most) {
    for (const bus::Time until = now_ + at_most; now_ < until;) {
      now_ += milliseconds(50);
      node_->Advance(now_);
      if (node_->done()) return true;
    }
    return false;
  }

  bus::Time now_{std::chrono::hours(1)};
  std::int64_t seq_ = 0;
  bus::Outbox out_{*this, 1};
  std::optional<RequestNode> node_;
};

TEST_F(RequestNodeTest, WithNoTimeForARefinedRouteTheBaselineIsWaitedFor) {
  Ask(seconds(0));
  EXPECT_FALSE(node_->done());
  Offer(kOldMap);
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(baseline_t::STATUS_OK, kOldMap);
  EXPECT_FALSE(EndsWithin(milliseconds(300))) << "nothing is deployed yet";
  Deployed(deployed_t::MODE_BASELINE, kOldMap);
  EXPECT_TRUE(node_->done());
  EXPECT_TRUE(node_->HasRoute());
}

TEST_F(RequestNodeTest, WithNoTimeAndNobodyThereItEndsAllTheSame) {
  Ask(seconds(0));
  EXPECT_FALSE(EndsWithin(milliseconds(1'900)));
  EXPECT_TRUE(EndsWithin(milliseconds(200)));
  EXPECT_THAT(WhyNoRoute(*node_), HasSubstr("no planner answered"));
}

TEST_F(RequestNodeTest, AShortWaitIsNoShorterForAFailure) {
  Ask(seconds(0));
  Offer(kOldMap);
  Baseline(baseline_t::STATUS_START_BLOCKED, kOldMap);
  Deployed(deployed_t::MODE_NONE, kOldMap);
  EXPECT_TRUE(node_->done());
}

// Each is about the map that the planner has.
class RequestOnAnOlderMapTest
    : public RequestNodeTest,
      public ::testing::WithParamInterface<std::int8_t> {};

TEST_P(RequestOnAnOlderMapTest, WaitsForTheMapInForce) {
  Ask(seconds(10));
  Offer(kNewMap);
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(GetParam(), kOldMap);
  EXPECT_FALSE(EndsWithin(seconds(9)));
  Baseline(baseline_t::STATUS_OK, kNewMap);
  EXPECT_EQ(node_->baseline_ms(), 9'000) << "of the route, not of the refusal";
  Deployed(deployed_t::MODE_BASELINE, kNewMap);
  Deployed(deployed_t::MODE_CANDIDATE, kNewMap);
  EXPECT_TRUE(node_->done());
  EXPECT_TRUE(node_->HasRoute());
}

TEST_P(RequestOnAnOlderMapTest, SaysTheReasonWhenTheMapNeverComes) {
  Ask(seconds(10));
  Offer(kNewMap);
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(GetParam(), kOldMap);
  EXPECT_FALSE(EndsWithin(milliseconds(9'900)));
  EXPECT_TRUE(EndsWithin(milliseconds(200)));
  EXPECT_THAT(WhyNoRoute(*node_),
              HasSubstr("terra-map offers map 200, which the planner did not "
                        "get in time"));
}

TEST_P(RequestOnAnOlderMapTest, IsOverWhereThePlannerHasTheMapInForce) {
  Ask(seconds(10));
  Offer(kNewMap);
  Deployed(deployed_t::MODE_NONE, kNewMap);
  Baseline(GetParam(), kNewMap);
  EXPECT_FALSE(EndsWithin(milliseconds(2'000)))
      << "a map file that was just edited is not offered yet";
  Baseline(GetParam(), kNewMap);
  EXPECT_TRUE(EndsWithin(milliseconds(600)));
}

TEST_P(RequestOnAnOlderMapTest, AnEditedMapIsWaitedForFromItsHeaderOn) {
  Ask(seconds(10));
  Offer(kOldMap);
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(GetParam(), kOldMap);
  EXPECT_FALSE(EndsWithin(milliseconds(1'900)));
  Offer(kNewMap);
  EXPECT_FALSE(EndsWithin(seconds(8)));
  EXPECT_TRUE(EndsWithin(milliseconds(200)));
}

INSTANTIATE_TEST_SUITE_P(Failures, RequestOnAnOlderMapTest,
                         ::testing::Values(baseline_t::STATUS_NO_ROUTE,
                                           baseline_t::STATUS_START_OUTSIDE,
                                           baseline_t::STATUS_GOAL_OUTSIDE,
                                           baseline_t::STATUS_START_BLOCKED,
                                           baseline_t::STATUS_GOAL_BLOCKED,
                                           baseline_t::STATUS_OTHER_MAP,
                                           baseline_t::STATUS_TOO_LONG));

TEST_F(RequestNodeTest, APlannerWithoutAMapIsWaitedFor) {
  Ask(seconds(10));
  Deployed(deployed_t::MODE_NONE, 0);
  Baseline(baseline_t::STATUS_NO_MAP, 0);
  EXPECT_FALSE(EndsWithin(milliseconds(9'900)));
  EXPECT_TRUE(EndsWithin(milliseconds(200)));
  EXPECT_THAT(WhyNoRoute(*node_), StartsWith("the planner has no map"));
}

TEST_F(RequestNodeTest, AFailureWithoutAMapServerSaysSo) {
  Ask(seconds(3));
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(baseline_t::STATUS_START_OUTSIDE, kOldMap);
  EXPECT_FALSE(EndsWithin(milliseconds(2'900)));
  EXPECT_TRUE(EndsWithin(milliseconds(200)));
  EXPECT_EQ(WhyNoRoute(*node_),
            "the start lies outside the map; no map was heard, is terra-map "
            "running?");
}

TEST_F(RequestNodeTest, AGateOnAnOlderMapIsWaitedFor) {
  Ask(seconds(10));
  Offer(kNewMap);
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(baseline_t::STATUS_OK, kNewMap);
  EXPECT_FALSE(EndsWithin(milliseconds(9'900)));
  EXPECT_TRUE(EndsWithin(milliseconds(200)));
  EXPECT_THAT(WhyNoRoute(*node_), HasSubstr("which the gate did not get"));
}

TEST_F(RequestNodeTest, ARouteOnAnOlderMapIsNotTheLastWord) {
  Ask(seconds(10));
  Offer(kNewMap);
  Baseline(baseline_t::STATUS_OK, kOldMap);
  Deployed(deployed_t::MODE_CANDIDATE, kOldMap);
  EXPECT_FALSE(EndsWithin(seconds(5)));
  Deployed(deployed_t::MODE_CANDIDATE, kNewMap);
  EXPECT_TRUE(node_->done());
}

TEST_F(RequestNodeTest, ACancelledRequestIsOver) {
  Ask(seconds(10));
  Deployed(deployed_t::MODE_NONE, kOldMap);
  Baseline(baseline_t::STATUS_CANCELLED, kOldMap);
  EXPECT_TRUE(node_->done());
}

}  // namespace
}  // namespace terra::cli

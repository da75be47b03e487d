// Requests: new, replaced, cancelled, and carried on by the planner.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/verifier/gate_field.h"
#include "verifier/gate.h"

namespace terra::verifier {
namespace {

using ::testing::IsEmpty;
using testing::MapFromAscii;

// ---- Requests. ----

TEST(GateTest, ANewRequestReplacesTheRoute) {
  GateHarness h = Ready();
  h.goal = {5, 2};
  const auto out = DeploymentsOf(h.Request(2));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kNone);
  EXPECT_EQ(out[0].cause, Cause::kNewRequest);
  EXPECT_EQ(out[0].request_id, 2);
  EXPECT_EQ(out[0].goal, (Cell{5, 2}));
  EXPECT_THAT(out[0].waypoints, IsEmpty());
}

TEST(GateTest, AReplacedRequestNeverComesBack) {
  GateHarness h = Ready();
  const BaselineEvent old = h.BaselineOf(kTop);
  h.Request(2);
  EXPECT_THAT(h.gate.On(RequestEvent{1, false, h.start, h.goal}), IsEmpty());
  EXPECT_THAT(h.gate.On(old), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 2);
  EXPECT_EQ(h.gate.counters().other_baselines, 1);
}

TEST(GateTest, RequestZeroIsNoRequest) {
  GateHarness h;
  h.Map(Field());
  EXPECT_THAT(h.Request(0), IsEmpty());
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty());
  EXPECT_THAT(h.Cancel(0), IsEmpty());
  EXPECT_EQ(h.deployed(), Deployed{});
  h = Ready();
  EXPECT_THAT(h.Request(0), IsEmpty());
  EXPECT_THAT(h.Cancel(0), IsEmpty());
  EXPECT_THAT(h.Baseline(kTop), IsEmpty());
  EXPECT_EQ(h.deployed().waypoints, kStraight);
}

TEST(GateTest, CancelWithdrawsTheRouteForGood) {
  GateHarness h = Ready();
  const AdviceEvent advice = h.AdviceOf(kTop);
  const auto out = DeploymentsOf(h.Cancel(1));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kNone);
  EXPECT_EQ(out[0].cause, Cause::kCancelled);
  EXPECT_EQ(out[0].request_id, 1);
  EXPECT_EQ(out[0].baseline_digest, 0) << "the baseline is withdrawn too";
  EXPECT_THAT(h.Cancel(1), IsEmpty());
  EXPECT_THAT(h.Request(1), IsEmpty());
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty());
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kStaleRequest);
  EXPECT_THAT(h.Map(MapFromAscii({"111111", "111111"})), IsEmpty());
  EXPECT_FALSE(h.deployed().has_route());
}

TEST(GateTest, CancelOfAnUnseenRequestKeepsItFromStarting) {
  GateHarness h = Ready();
  EXPECT_THAT(h.Cancel(9), IsEmpty());
  EXPECT_THAT(h.Request(9), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 1);
  EXPECT_TRUE(h.deployed().has_route());
}

TEST(GateTest, ACancelledRequestDoesNotStartWithABaseline) {
  GateHarness h;
  h.Map(Field());
  h.Cancel(9);
  h.request_id = 9;
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty());
  EXPECT_EQ(h.deployed(), Deployed{});
}

TEST(GateTest, APlannerThatHeardTheCancelCarriesItOn) {
  GateHarness h = Ready();
  BaselineEvent event = h.BaselineOf({});
  event.has_route = false;
  event.cancelled = true;
  const auto out = DeploymentsOf(h.gate.On(event));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].cause, Cause::kCancelled);
  EXPECT_THAT(h.gate.On(event), IsEmpty());
}

// ---- Requests carried by the planner. ----

TEST(GateTest, ARestartedGateTakesTheRequestFromTheBaseline) {
  GateHarness h;
  h.Map(Field());
  h.request_id = 1;
  const auto out = DeploymentsOf(h.Baseline(kStraight));
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].cause, Cause::kNewRequest);
  EXPECT_EQ(out[1].mode, Mode::kBaseline);
  EXPECT_EQ(out[1].request_id, 1);
  EXPECT_EQ(out[1].start, h.start);
}

TEST(GateTest, ARestartedGateTakesACancelledRequestAsCancelled) {
  GateHarness h;
  h.Map(Field());
  h.request_id = 1;
  BaselineEvent event = h.BaselineOf({});
  event.has_route = false;
  event.cancelled = true;
  const auto out = DeploymentsOf(h.gate.On(event));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].cause, Cause::kCancelled);
  EXPECT_EQ(out[0].request_id, 1);
  EXPECT_THAT(h.Request(1), IsEmpty());
}

TEST(GateTest, APlannerThatMovedOnTakesTheGateAlong) {
  GateHarness h = Ready();
  h.request_id = 2;
  const auto out = DeploymentsOf(h.Baseline(kTop));
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[1].request_id, 2);
  EXPECT_EQ(out[1].waypoints, kTop);
}

TEST(GateTest, APlannerMayMoveOnAgainAndAgain) {
  GateHarness h;
  h.Map(Field());
  for (const std::int64_t id : {1, 2, 3}) {
    h.request_id = id;
    h.Baseline(kStraight);
    EXPECT_EQ(h.deployed().request_id, id);
  }
}

TEST(GateTest, APlannerThatMovedOnDoesNotTakeTheGateBack) {
  GateHarness h = Ready();
  const BaselineEvent old = h.BaselineOf(kTop);
  h.request_id = 2;
  h.Baseline(kStraight);
  EXPECT_THAT(h.gate.On(old), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 2);
}

TEST(GateTest, APlannerThatKnewOnlyAnEarlierRequestIsNotFollowed) {
  GateHarness h = Ready();
  h.Request(2);
  h.request_id = 3;
  EXPECT_THAT(h.Baseline(kTop), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 2);
}

TEST(GateTest, APlannerWithoutASessionIsNotFollowed) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.request_id = 2;
  BaselineEvent event = h.BaselineOf(kTop);
  event.session = 0;
  EXPECT_THAT(h.gate.On(event), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 1);
}

TEST(GateTest, APlannerThatIsOnlyLateDoesNotUndoARequest) {
  GateHarness h;
  h.Map(Field());
  h.request_id = 1;
  const BaselineEvent late = h.BaselineOf(kTop);
  h.Request(2);
  EXPECT_THAT(h.gate.On(late), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 2);
  EXPECT_THAT(DeploymentsOf(h.Baseline(kStraight)).size(), 1u);
}

TEST(GateTest, AnotherPlannerDoesNotMoveTheRequest) {
  GateHarness h = Ready();
  h.request_id = 2;
  BaselineEvent other = h.BaselineOf(kTop);
  other.session = 501;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  EXPECT_EQ(h.deployed().request_id, 1);
}

}  // namespace
}  // namespace terra::verifier

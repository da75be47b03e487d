#include "advisor/anchor.h"

#include <limits>

#include <gtest/gtest.h>

#include "terrain/segment.h"
#include "tests/support/random_map.h"

namespace terra::advisor {
namespace {

constexpr std::int64_t kSession = 5;
constexpr std::int64_t kRouteSeq = 3;
constexpr std::int64_t kRequest = 11;
constexpr std::int64_t kMap = 77;
const Route kRoute = {{0, 10}, {100, 10}, {100, 200}};

DeployedRoute Deployed(const Route& route = kRoute) {
  return {kSession, kRouteSeq, kRequest, kMap, route};
}

AnchorQuestion Question(double latency_s, double now_s = 0) {
  return {kRequest, kMap, kRoute.front(), latency_s, now_s};
}

TEST(AnchorChooser, WithoutARobotTheProposalRunsFromTheStart) {
  AnchorChooser chooser;
  const Anchor start{0, 0, 0, kRoute.front()};
  EXPECT_EQ(chooser.Choose(Question(30)), start);
  chooser.OnDeployed(Deployed());
  EXPECT_EQ(chooser.Choose(Question(30)), start);
  EXPECT_TRUE(chooser.InForce(start, kRequest));
}

TEST(AnchorChooser, ARobotThatStandsAtTheStartIsThePapersCase) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, kRoute.front(), 0, 0);
  EXPECT_EQ(chooser.Choose(Question(30))->index, 0);
}

TEST(AnchorChooser, ForARobotThatDrivesItIsAsFarAheadAsItComesMeanwhile) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, {20, 10}, 2, 0);
  const auto anchor = chooser.Choose(Question(30));
  ASSERT_TRUE(anchor);
  EXPECT_EQ(anchor->index, 20 + 2 * 30 + AnchorChooser::kMarginCells);
  EXPECT_EQ(anchor->cell, (Cell{90, 10}));
  EXPECT_EQ(anchor->session, kSession);
  EXPECT_EQ(anchor->route_seq, kRouteSeq);
}

TEST(AnchorChooser, ARobotThatRestsOnItsWayGetsTheMarginAlone) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, {20, 10}, 0, 0);
  EXPECT_EQ(chooser.Choose(Question(30))->index,
            20 + AnchorChooser::kMarginCells);
}

TEST(AnchorChooser, AsksNothingCloseToTheGoal) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, {100, 150}, 2, 0);
  EXPECT_FALSE(chooser.Choose(Question(30)));
  EXPECT_TRUE(chooser.Choose(Question(10)));
}

TEST(AnchorChooser, WaitsForTheRouteOfARobotThatDrives) {
  AnchorChooser chooser;
  chooser.OnPose(kSession, kRouteSeq - 1, {50, 50}, 2, 0);
  EXPECT_FALSE(chooser.Choose(Question(30, 1)));
  chooser.OnDeployed(Deployed());
  EXPECT_TRUE(chooser.Choose(Question(30, 1)));
}

TEST(AnchorChooser, ARobotThatFellSilentDoesNotHoldUpTheFirstProposal) {
  AnchorChooser chooser;
  chooser.OnPose(kSession, kRouteSeq - 1, {50, 50}, 2, 0);
  EXPECT_EQ(chooser.Choose(Question(30, 10))->index, 0);
}

TEST(AnchorChooser, WaitsForARobotOffItsRoute) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, {20, 60}, 2, 0);
  EXPECT_FALSE(chooser.Choose(Question(1)));
  chooser.OnPose(kSession, kRouteSeq, {20, 11}, 2, 0);
  EXPECT_TRUE(chooser.Choose(Question(1)));
}

TEST(AnchorChooser, APassedAnchorAndOneOnAnotherRouteAreNoLongerInForce) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, {20, 10}, 1, 0);
  const Anchor anchor = chooser.Choose(Question(5)).value();
  EXPECT_TRUE(chooser.InForce(anchor, kRequest));
  EXPECT_FALSE(chooser.InForce({0, 0, 0, kRoute.front()}, kRequest));
  chooser.OnPose(kSession, kRouteSeq, {anchor.cell.x + 1, 10}, 1, 6);
  EXPECT_FALSE(chooser.InForce(anchor, kRequest));

  AnchorChooser other;
  DeployedRoute next = Deployed();
  other.OnDeployed(next);
  ++next.route_seq;
  other.OnDeployed(next);
  EXPECT_FALSE(other.InForce(anchor, kRequest));
  EXPECT_TRUE(other.InForce({0, 0, 0, kRoute.front()}, kRequest));
}

TEST(AnchorChooser, WhatTheRobotDroveForAnEarlierRequestDoesNotCount) {
  AnchorChooser chooser;
  chooser.OnDeployed(Deployed());
  chooser.OnPose(kSession, kRouteSeq, {90, 10}, 0, 0);
  AnchorQuestion next = Question(30);
  next.request_id = kRequest + 1;
  next.start = {90, 10};
  const auto anchor = chooser.Choose(next);
  ASSERT_TRUE(anchor);
  EXPECT_EQ(*anchor, (Anchor{0, 0, 0, {90, 10}}));
  EXPECT_TRUE(chooser.InForce(*anchor, next.request_id));
}

TEST(AnchorChooser, TheRestOfARouteVisitsExactlyItsCells) {
  testing::Random random(4);
  for (int round = 0; round < 200; ++round) {
    Route route = {{random.Int(0, 99), random.Int(0, 99)}};
    while (route.size() < 4) {
      route.push_back({random.Int(0, 99), random.Int(0, 99)});
    }
    const CellPath cells = RasterizeRoute(route);
    AnchorChooser chooser;
    chooser.OnDeployed(Deployed(route));
    chooser.OnPose(kSession, kRouteSeq, route.front(), 0.1, 0);
    AnchorQuestion question = Question(random.Int(0, 1'000));
    question.start = route.front();
    const auto anchor = chooser.Choose(question);
    if (!anchor) continue;
    EXPECT_EQ(RasterizeRoute(chooser.RouteFrom(*anchor)),
              CellPath(cells.begin() + anchor->index, cells.end()));
  }
}

TEST(AnchorChooser, HostilePosesAreHarmless) {
  for (const double speed :
       {std::numeric_limits<double>::quiet_NaN(),
        std::numeric_limits<double>::infinity(), -1.0, 1e300}) {
    AnchorChooser chooser;
    chooser.OnDeployed(Deployed());
    chooser.OnPose(
        kSession, kRouteSeq,
        {std::numeric_limits<int>::min(), std::numeric_limits<int>::max()},
        speed, 0);
    chooser.OnPose(kSession, kRouteSeq, {20, 10}, speed, 0);
    const auto anchor = chooser.Choose(Question(1e9));
    EXPECT_TRUE(!anchor || anchor->index < 291);
  }
}

TEST(AnswerTime, IsALittleMoreThanTheLongestOfTheLastAnswers) {
  AnswerTime time(30);
  EXPECT_EQ(time.seconds(), 30);
  time.Add(10);
  time.Add(5);
  EXPECT_NEAR(time.seconds(), 12, 1e-9);
  for (int i = 0; i < 8; ++i) time.Add(1);
  EXPECT_NEAR(time.seconds(), 1.2, 1e-9);
  time.AtLeast(3);
  EXPECT_NEAR(time.seconds(), 6, 1e-9);
}

}  // namespace
}  // namespace terra::advisor

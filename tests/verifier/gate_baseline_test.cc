// Baselines: another one, an invalid one, none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/verifier/gate_field.h"
#include "verifier/gate.h"

namespace terra::verifier {
namespace {

using ::testing::IsEmpty;
using testing::MapFromAscii;

// ---- Baselines. ----

TEST(GateTest, ACheaperBaselineIsDeployedADearerOneIsNot) {
  GateHarness h = Ready();
  const auto cheaper = DeploymentsOf(h.Baseline(kCorners));
  ASSERT_EQ(cheaper.size(), 1u);
  EXPECT_EQ(cheaper[0].waypoints, kCorners);
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty());
  EXPECT_EQ(h.deployed().waypoints, kCorners);
  EXPECT_EQ(CodeOf(h.Advise(kCorners)), Code::kNotBest);
  EXPECT_EQ(CodeOf(h.Advise(kTop)), Code::kAccepted);
}

TEST(GateTest, ABaselineCheaperThanTheCandidateReplacesIt) {
  GateHarness h = Ready();
  h.Advise(kCorners);
  const auto out = DeploymentsOf(h.Baseline(kTop));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kBaseline);
  EXPECT_EQ(out[0].waypoints, kTop);
}

TEST(GateTest, EachInvalidBaselineIsReportedAndNeverDeployed) {
  struct Row {
    const char* name;
    Route route;
    Code code;
    int segment;
    Cell cell;
  };
  const Row rows[] = {
      {"too few", {{0, 1}}, Code::kTooFewWaypoints, -1, {}},
      {"other start", {{1, 1}, {5, 1}}, Code::kStartMismatch, 0, {1, 1}},
      {"other goal", {{0, 1}, {4, 1}}, Code::kGoalMismatch, 0, {4, 1}},
      {"outside", {{0, 1}, {6, 1}, {5, 1}}, Code::kOutOfBounds, 0, {6, 1}},
      {"blocked", {{0, 1}, {0, 3}, {5, 1}}, Code::kObstacle, 0, {0, 3}},
  };
  for (const Row& row : rows) {
    GateHarness h;
    h.Map(MapFromAscii({"111111", "199991", "111111", "#11111"}));
    h.Request(1);
    const Decisions out = h.Baseline(row.route);
    ASSERT_EQ(out.size(), 2u) << row.name;
    const Verdict& verdict = std::get<Verdict>(out[0]);
    EXPECT_EQ(verdict.subject, Subject::kBaseline) << row.name;
    EXPECT_EQ(CodeName(verdict.code), CodeName(row.code)) << row.name;
    EXPECT_EQ(verdict.request_id, 1) << row.name;
    EXPECT_EQ(verdict.map_id, h.map_id) << row.name;
    EXPECT_EQ(verdict.baseline_digest, h.baseline_digest) << row.name;
    EXPECT_EQ(verdict.advisor, "planner") << row.name;
    EXPECT_EQ(verdict.advisor_session, 500) << row.name;
    EXPECT_EQ(verdict.fail_segment, row.segment) << row.name;
    EXPECT_EQ(verdict.fail_cell, row.cell) << row.name;
    EXPECT_EQ(h.deployed().mode, Mode::kHold) << row.name;
    EXPECT_EQ(h.deployed().cause, Cause::kBaselineInvalid) << row.name;
    EXPECT_THAT(h.Baseline(row.route), IsEmpty()) << "repeated: " << row.name;
    EXPECT_EQ(h.gate.counters().invalid_baselines, 1) << row.name;
  }
}

TEST(GateTest, ABaselineOverTheLimitsIsInvalid) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  Route route = kStraight;
  route.insert(route.begin(), 2'047, route.front());
  EXPECT_EQ(CodeOf(h.Baseline(route)), Code::kWorkLimit);
  route.erase(route.begin());
  EXPECT_EQ(DeploymentsOf(h.Baseline(route)).size(), 1u);
}

TEST(GateTest, ABaselineThatIsNotWhatItsDigestSaysIsMalformed) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  BaselineEvent event = h.BaselineOf(kStraight);
  event.waypoints = kTop;
  EXPECT_EQ(CodeOf(h.gate.On(event)), Code::kMalformedMessage);
  EXPECT_EQ(h.deployed().mode, Mode::kHold);
  h.Map(MapFromAscii({"111111", "111111", "111111"}));
  EXPECT_EQ(h.deployed().mode, Mode::kHold) << "no map makes it good";
}

TEST(GateTest, ARepetitionIsTheSameInEveryPart) {
  GateHarness h = Ready();
  BaselineEvent event = h.BaselineOf(kStraight);
  event.waypoints = kTop;
  EXPECT_EQ(CodeOf(h.gate.On(event)), Code::kMalformedMessage);
  h = Ready();
  event = h.BaselineOf(kStraight);
  event.baseline_digest += 1;
  EXPECT_EQ(CodeOf(h.gate.On(event)), Code::kMalformedMessage);
  h = Ready();
  event = h.BaselineOf(kStraight);
  h.Map(MapFromAscii({"111111", "199991", "111112"}));
  event.map_id = h.map_id;
  EXPECT_EQ(CodeOf(h.gate.On(event)), Code::kMalformedMessage)
      << "the digest is that of the old map";
}

TEST(GateTest, HoldIsSaidOnceHoweverManyBaselinesAreInvalid) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  EXPECT_EQ(h.Baseline({{0, 1}, {9, 9}, {5, 1}}).size(), 2u);
  const Decisions out = h.Baseline({{0, 1}, {8, 8}, {5, 1}});
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(std::get<Verdict>(out[0]).fail_cell, (Cell{2, 3}));
}

TEST(GateTest, NoAdviceIsAcceptedOnAnInvalidBaseline) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.Baseline({{0, 1}, {9, 9}, {5, 1}});
  EXPECT_EQ(CodeOf(h.Advise(kTop)), Code::kBaselineInvalid);
  EXPECT_EQ(h.deployed().mode, Mode::kHold);
}

TEST(GateTest, AnInvalidBaselineLeavesTheDeployedRouteInForce) {
  GateHarness h = Ready();
  h.Advise(kTop);
  const Deployed before = h.deployed();
  const Decisions out = h.Baseline({{0, 1}, {9, 9}, {5, 1}});
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(std::get<Verdict>(out[0]).cost_to_beat, before.cost);
  EXPECT_EQ(h.deployed(), before);
  EXPECT_EQ(CodeOf(h.Advise(kBottom)), Code::kBaselineInvalid);
}

TEST(GateTest, AValidBaselineEndsTheHold) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.Baseline({{0, 1}, {9, 9}, {5, 1}});
  const auto out = DeploymentsOf(h.Baseline(kStraight));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kBaseline);
}

TEST(GateTest, BaselinesOfAnotherMapAreOnlyCounted) {
  GateHarness h = Ready();
  BaselineEvent event = h.BaselineOf(kTop);
  event.map_id += 1;
  event.baseline_digest = BaselineDigest(1, event.map_id, kTop);
  EXPECT_THAT(h.gate.On(event), IsEmpty());
  event.has_route = false;
  EXPECT_THAT(h.gate.On(event), IsEmpty());
  EXPECT_EQ(h.gate.counters().other_baselines, 2);
  EXPECT_EQ(CodeOf(h.Advise(kTop)), Code::kAccepted) << "the baseline stands";
}

TEST(GateTest, ABaselineBeforeTheMapWaitsForItsRepetition) {
  GateHarness h;
  h.Request(1);
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty()) << "for no map at all";
  h.map_id = MapId(Field());
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty());
  h.Map(Field());
  EXPECT_EQ(DeploymentsOf(h.Baseline(kStraight)).size(), 1u);
}

// ---- No route. ----

TEST(GateTest, NoRouteIsSaidOncePerMap) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  const auto out = DeploymentsOf(h.NoRoute());
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kNone);
  EXPECT_EQ(out[0].cause, Cause::kNoRoute);
  EXPECT_THAT(h.NoRoute(), IsEmpty());
  h.Map(MapFromAscii({"111111", "199991"}));
  const auto again = DeploymentsOf(h.NoRoute());
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].map_id, h.map_id);
  EXPECT_EQ(DeploymentsOf(h.Baseline(kStraight)).size(), 1u);
}

TEST(GateTest, NoRouteLeavesAValidRouteInForceWithoutItsBaseline) {
  GateHarness h = Ready();
  h.Advise(kCorners);
  const Deployed before = h.deployed();
  EXPECT_THAT(h.NoRoute(), IsEmpty());
  EXPECT_EQ(h.deployed(), before);
  EXPECT_EQ(CodeOf(h.Advise(kTop)), Code::kStaleBaseline);
}

TEST(GateTest, NoRouteEndsTheHold) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.Baseline({{0, 1}, {9, 9}, {5, 1}});
  const auto out = DeploymentsOf(h.NoRoute());
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].cause, Cause::kNoRoute);
}

}  // namespace
}  // namespace terra::verifier

// Another map comes into force.
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/verifier/gate_field.h"
#include "verifier/gate.h"

namespace terra::verifier {
namespace {

using ::testing::IsEmpty;
using testing::MapFromAscii;

TEST(GateTest, ACandidateThatIsStillCheaperStays) {
  GateHarness h = Ready();
  h.Advise(kTop);
  const std::int64_t before = h.deployed().route_seq;
  const auto out = DeploymentsOf(h.Map(MapFromAscii({"122221", "155551"})));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kCandidate);
  EXPECT_EQ(out[0].cause, Cause::kMapUpdate);
  EXPECT_EQ(out[0].map_id, h.map_id);
  EXPECT_EQ(out[0].waypoints, kTop);
  EXPECT_NEAR(out[0].cost, 6 + 3 * std::numbers::sqrt2, 1e-9);
  EXPECT_EQ(out[0].baseline_cost, 21);
  EXPECT_EQ(out[0].baseline_digest, h.baseline_digest);
  EXPECT_EQ(out[0].source, "search");
  EXPECT_EQ(out[0].route_seq, before + 1);
}

TEST(GateTest, ABlockedCandidateRevertsToTheBaseline) {
  GateHarness h = Ready();
  h.Advise(kTop);
  const auto out = DeploymentsOf(h.Map(MapFromAscii({"11#111", "199991"})));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kBaseline);
  EXPECT_EQ(out[0].cause, Cause::kRevertBlocked);
  EXPECT_EQ(out[0].waypoints, kStraight);
  EXPECT_EQ(out[0].cost, 37);
  EXPECT_EQ(out[0].baseline_digest, h.baseline_digest);
  EXPECT_EQ(out[0].source, "planner");
}

TEST(GateTest, ACandidateThatIsNoLongerCheaperReverts) {
  GateHarness h = Ready();
  h.Advise(kCorners);
  // 7 over the corners, 7 straight.
  const auto out = DeploymentsOf(h.Map(MapFromAscii({"111111", "131111"})));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kBaseline);
  EXPECT_EQ(out[0].cause, Cause::kRevertNotCheaper);
  EXPECT_EQ(out[0].cost, 7);
}

TEST(GateTest, ACandidateOnABlockedBaselineStaysWithoutAComparison) {
  GateHarness h = Ready();
  h.Advise(kTop);
  const Decisions out = h.Map(MapFromAscii({"111111", "19#991"}));
  ASSERT_EQ(out.size(), 2u);
  const Verdict& verdict = std::get<Verdict>(out[0]);
  EXPECT_EQ(verdict.subject, Subject::kBaseline);
  EXPECT_EQ(verdict.code, Code::kObstacle);
  EXPECT_EQ(verdict.map_id, h.map_id);
  EXPECT_EQ(verdict.fail_cell, (Cell{2, 1}));
  const Deployed& deployed = std::get<Deployed>(out[1]);
  EXPECT_EQ(deployed.mode, Mode::kCandidate);
  EXPECT_EQ(deployed.cause, Cause::kMapUpdate);
  EXPECT_EQ(deployed.baseline_cost, kImpassable);
}

// The one held, which was dearer and so never deployed, not the one that the
// candidate was once compared with.
TEST(GateTest, ACandidateThatStaysNamesTheBaselineHeld) {
  GateHarness h = Ready();
  h.Advise(kTop);
  h.Baseline(kBottom);
  h.Map(MapFromAscii({"111111", "155551", "1#1111"}));
  EXPECT_EQ(h.deployed().mode, Mode::kCandidate);
  EXPECT_EQ(h.deployed().waypoints, kTop);
  EXPECT_EQ(h.deployed().baseline_digest, h.baseline_digest);
  EXPECT_EQ(h.deployed().baseline_cost, kImpassable);
}

TEST(GateTest, ACandidateThatStaysWithoutABaselineNamesNone) {
  const auto no_route = [](GateHarness& h) {
    h.NoRoute();
  };
  const auto forged = [](GateHarness& h) {
    BaselineEvent event = h.BaselineOf(kStraight);
    ++event.baseline_digest;
    h.gate.On(event);
  };
  for (const auto& lose : {std::function<void(GateHarness&)>(no_route),
                           std::function<void(GateHarness&)>(forged)}) {
    GateHarness h = Ready();
    h.Advise(kTop);
    lose(h);
    h.Map(MapFromAscii({"122221", "155551"}));
    EXPECT_EQ(h.deployed().mode, Mode::kCandidate);
    EXPECT_EQ(h.deployed().baseline_digest, 0);
    EXPECT_EQ(h.deployed().baseline_cost, kImpassable);
  }
}

TEST(GateTest, NothingValidOnTheNewMapMeansHold) {
  GateHarness h = Ready();
  h.Advise(kTop);
  h.Map(MapFromAscii({"11#111", "19#991"}));
  EXPECT_EQ(h.deployed().mode, Mode::kHold);
  EXPECT_EQ(h.deployed().cause, Cause::kRevertBlocked);
  EXPECT_THAT(h.deployed().waypoints, IsEmpty());
}

TEST(GateTest, ABlockedBaselineAloneMeansHold) {
  GateHarness h = Ready();
  h.Map(MapFromAscii({"111111", "19#991"}));
  EXPECT_EQ(h.deployed().mode, Mode::kHold);
  EXPECT_EQ(h.deployed().cause, Cause::kBaselineInvalid);
}

TEST(GateTest, HoldFollowsTheMapAndEndsWhenTheBaselineIsGoodAgain) {
  GateHarness h = Ready();
  h.Map(MapFromAscii({"111111", "19#991"}));
  const auto still = DeploymentsOf(h.Map(MapFromAscii({"111111", "1#9991"})));
  ASSERT_EQ(still.size(), 1u);
  EXPECT_EQ(still[0].mode, Mode::kHold);
  EXPECT_EQ(still[0].map_id, h.map_id);
  const auto good = DeploymentsOf(h.Map(MapFromAscii({"111111", "191991"})));
  ASSERT_EQ(good.size(), 1u);
  EXPECT_EQ(good[0].mode, Mode::kBaseline);
  EXPECT_EQ(good[0].cause, Cause::kMapUpdate);
  EXPECT_EQ(good[0].cost, 29);
}

TEST(GateTest, ADeployedBaselineIsCostedAnewOnTheNewMap) {
  GateHarness h = Ready();
  const auto out = DeploymentsOf(h.Map(MapFromAscii({"111111", "122221"})));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kBaseline);
  EXPECT_EQ(out[0].cause, Cause::kMapUpdate);
  EXPECT_EQ(out[0].cost, 9);
  EXPECT_EQ(out[0].baseline_cost, 9);
}

// The deployed baseline is an earlier, cheaper one than the baseline held.
TEST(GateTest, AnEarlierBaselineStaysWhileItIsNotDearer) {
  GateHarness h = Ready();
  h.Baseline(kTop);
  const std::int64_t digest = h.baseline_digest;
  h.Baseline(kStraight);
  h.Map(MapFromAscii({"111111", "155551", "111111"}));
  EXPECT_EQ(h.deployed().waypoints, kTop);
  EXPECT_EQ(h.deployed().mode, Mode::kBaseline);
  EXPECT_EQ(h.deployed().baseline_digest, digest);
  EXPECT_EQ(h.deployed().baseline_cost, h.deployed().cost);
  h.Map(MapFromAscii({"111111", "1#5551", "111111"}));
  EXPECT_EQ(h.deployed().waypoints, kTop) << "the baseline held is blocked";
  h.Map(MapFromAscii({"199991", "111111", "111111"}));
  EXPECT_EQ(h.deployed().waypoints, kStraight);
  EXPECT_EQ(h.deployed().cause, Cause::kRevertNotCheaper);
}

TEST(GateTest, AnEarlierBaselineThatIsBlockedGivesWay) {
  GateHarness h = Ready();
  h.Baseline(kTop);
  h.Baseline(kStraight);
  h.Map(MapFromAscii({"11#111", "155551", "111111"}));
  EXPECT_EQ(h.deployed().waypoints, kStraight);
  EXPECT_EQ(h.deployed().cause, Cause::kRevertBlocked);
}

TEST(GateTest, TheSameMapAgainChangesNothing) {
  GateHarness h = Ready();
  h.Advise(kTop);
  EXPECT_THAT(h.Map(Field()), IsEmpty());
  EXPECT_EQ(h.deployed().waypoints, kTop);
}

TEST(GateTest, AfterAMapUpdateThePlannersNextBaselineCounts) {
  GateHarness h = Ready();
  h.Map(MapFromAscii({"111111", "155551", "111111"}));
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty()) << "same cost, same route";
  EXPECT_EQ(CodeOf(h.Advise(kTop)), Code::kAccepted);
}

TEST(GateTest, TheFirstMapIsTakenWhateverItsId) {
  Gate gate;
  gate.On(MapEvent{std::make_shared<const TerrainMap>(Field()), 0});
  EXPECT_TRUE(gate.has_map());
}

TEST(GateTest, AMapMustBeThere) {
  Gate gate;
  EXPECT_FALSE(gate.has_map());
  EXPECT_THROW(gate.On(MapEvent{nullptr, 1}), std::logic_error);
}

}  // namespace
}  // namespace terra::verifier

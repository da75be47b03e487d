// The gate while the robot drives: anchors ahead of it, poses, late advice.

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/segment.h"
#include "tests/support/ascii_map.h"
#include "tests/verifier/gate_harness.h"

namespace terra::verifier {
namespace {

using std::numbers::sqrt2;
using ::testing::IsEmpty;
using testing::MapFromAscii;

// 30 cells of cost 5 between two lanes of cost 1.
TerrainMap Road() {
  return MapFromAscii({"111111111111111111111111111111",
                       "155555555555555555555555555551",
                       "111111111111111111111111111111"});
}
const Route kStraight = {{0, 1}, {29, 1}};

GateHarness Ready() {
  GateHarness h;
  h.goal = {29, 1};
  h.Map(Road());
  h.Request(1);
  h.Baseline(kStraight);
  return h;
}

TEST(GateMotionTest, AProposalFromAnAnchorKeepsTheWayUpToIt) {
  GateHarness h = Ready();
  const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
  const Decisions out = h.gate.On(h.AdviceFrom(10, {10, 1}, tail));
  ASSERT_EQ(out.size(), 2u);
  const Verdict& verdict = std::get<Verdict>(out[0]);
  EXPECT_EQ(verdict.code, Code::kAccepted);
  EXPECT_NEAR(verdict.candidate_cost, 17 + 2 * sqrt2, 1e-9);
  EXPECT_EQ(verdict.cost_to_beat, 18 * 5 + 1) << "from the anchor on";
  EXPECT_EQ(verdict.baseline_cost, 28 * 5 + 1) << "the whole";
  EXPECT_EQ(verdict.anchor.index, 10);
  const Deployed& deployed = std::get<Deployed>(out[1]);
  EXPECT_EQ(deployed.mode, Mode::kCandidate);
  EXPECT_EQ(deployed.waypoints,
            (Route{{0, 1}, {10, 1}, {11, 0}, {28, 0}, {29, 1}}));
  EXPECT_NEAR(deployed.cost, 50 + 17 + 2 * sqrt2, 1e-9);
}

TEST(GateMotionTest, AnAnchorBehindTheRobotIsLate) {
  const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
  for (const int robot : {9, 10, 11}) {
    GateHarness h = Ready();
    EXPECT_THAT(h.Pose({robot, 1}), IsEmpty());
    EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 1}, tail))),
              robot <= 10 ? Code::kAccepted : Code::kLate);
  }
}

TEST(GateMotionTest, OnceTheRobotDrivesTheStartIsLate) {
  GateHarness h = Ready();
  const Route whole = {{0, 1}, {1, 0}, {28, 0}, {29, 1}};
  h.Pose({1, 1});
  EXPECT_EQ(CodeOf(h.Advise(whole)), Code::kLate);
  EXPECT_EQ(h.deployed().mode, Mode::kBaseline);
}

TEST(GateMotionTest, AnAnchorOnARouteThatIsNotInForceIsLate) {
  const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceFrom(10, {10, 1}, tail);
  advice.anchor.route_seq -= 1;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kLate);
  advice = h.AdviceFrom(10, {10, 1}, tail);
  advice.anchor.session += 1;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kLate);
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 1}, tail))),
            Code::kAccepted);
}

TEST(GateMotionTest, WithoutASessionOnlyTheStartIsAnAnchor) {
  GateHarness h = Ready();
  h.gate = Gate{};
  h.map_id = 0;
  h.Map(Road());
  h.Request(1);
  h.Baseline(kStraight);
  AdviceEvent advice =
      h.AdviceFrom(10, {10, 1}, {{10, 1}, {11, 0}, {28, 0}, {29, 1}});
  advice.anchor.session = 0;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kLate);
  EXPECT_EQ(CodeOf(h.Advise({{0, 1}, {1, 0}, {28, 0}, {29, 1}})),
            Code::kAccepted);
}

TEST(GateMotionTest, IndicesOffTheRouteAreLate) {
  GateHarness h = Ready();
  for (const int index : {-1, 30, 2'000'000'000, -2'000'000'000}) {
    EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(index, {10, 1}, kStraight))),
              Code::kLate)
        << index;
  }
}

TEST(GateMotionTest, TheAnchorsCellMustBeTheRoutes) {
  GateHarness h = Ready();
  const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {11, 1}, tail))),
            Code::kStartMismatch);
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(11, {11, 1}, tail))),
            Code::kStartMismatch)
      << "the proposal starts elsewhere";
}

TEST(GateMotionTest, TheRestMustBeCheaperNotTheWhole) {
  GateHarness h = Ready();
  h.Advise({{0, 1}, {1, 0}, {28, 0}, {29, 1}});
  const Route same = {{10, 0}, {28, 0}, {29, 1}};
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 0}, same))), Code::kNotBest);
  const Route worse = {{10, 0}, {11, 1}, {29, 1}};
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 0}, worse))),
            Code::kNotBest);
  const Route worst = {{10, 0}, {11, 1}, {10, 1}, {29, 1}, {20, 1}, {29, 1}};
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 0}, worst))),
            Code::kNotCheaper);
}

TEST(GateMotionTest, TheMarginCountsFromTheAnchorOn) {
  for (const double margin : {71.0, 72.0}) {
    GateHarness h(margin);
    h.goal = {29, 1};
    h.Map(Road());
    h.Request(1);
    h.Baseline(kStraight);
    // Saves 91 - 17 - 2 sqrt 2 = 71.17.
    const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
    EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 1}, tail))),
              margin < 71.17 ? Code::kAccepted : Code::kBelowMargin);
  }
}

TEST(GateMotionTest, TheRobotKeepsItsPlaceOverAnUpgrade) {
  GateHarness h = Ready();
  h.Pose({8, 1});
  const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 1}, tail))),
            Code::kAccepted);
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(7, {7, 1}, kStraight))), Code::kLate);
  EXPECT_EQ(CodeOf(h.gate.On(
                h.AdviceFrom(9, {9, 1}, {{9, 1}, {10, 0}, {28, 0}, {29, 1}}))),
            Code::kAccepted);
}

TEST(GateMotionTest, PosesOnAnotherRouteDoNotCount) {
  GateHarness h = Ready();
  const std::int64_t seq = h.deployed().route_seq;
  h.gate.On(PoseEvent{{20, 1}, GateHarness::kSession, seq - 1});
  h.gate.On(PoseEvent{{20, 1}, GateHarness::kSession + 1, seq});
  EXPECT_EQ(h.gate.counters().other_poses, 2);
  EXPECT_EQ(CodeOf(h.Advise({{0, 1}, {1, 0}, {28, 0}, {29, 1}})),
            Code::kAccepted);
}

TEST(GateMotionTest, PosesWithoutARouteDoNotCount) {
  GateHarness h;
  h.Request(1);
  h.Pose({3, 1});
  EXPECT_EQ(h.gate.counters().other_poses, 1);
}

TEST(GateMotionTest, ARobotOffTheRouteGetsNoAdvice) {
  GateHarness h = Ready();
  h.Pose({10, 40});
  const Route tail = {{10, 1}, {11, 0}, {28, 0}, {29, 1}};
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 1}, tail))), Code::kLate);
  h.Pose({9, 1});
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(10, {10, 1}, tail))),
            Code::kAccepted);
}

TEST(GateMotionTest, LateComesBeforeWhatTheAnswerSays) {
  GateHarness h = Ready();
  h.Pose({20, 1});
  AdviceEvent advice = h.AdviceFrom(10, {10, 1}, {});
  advice.kind = AdviceKind::kRetain;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kLate);
  advice.attempt += 1;
  advice.anchor = Anchor{GateHarness::kSession, h.deployed().route_seq, 25, {}};
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kRetained);
}

// The way up to the anchor is given by its corners, which count.
TEST(GateMotionTest, AWholeRouteOverTheLimitsIsRefused) {
  GateHarness h;
  h.start = {0, 0};
  h.goal = {29, 1};
  h.Map(MapFromAscii(
      {"111111111111111111111111111111", "199999999999999999999999999991"}));
  h.Request(1);
  h.Baseline({{0, 0}, {29, 1}});
  const std::vector<Cell> cells = RasterizeRoute({{0, 0}, {29, 1}});
  Route tail = {cells[20], {21, 0}, {28, 0}, {29, 1}};
  tail.insert(tail.begin(), 2'048 - tail.size(), tail.front());
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(20, cells[20], tail))),
            Code::kWorkLimit);
  tail.erase(tail.begin(), tail.begin() + 10);
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(20, cells[20], tail))),
            Code::kAccepted);
}

// Its route is withdrawn with the old request, also where the same one is
// deployed for the next at once.
TEST(GateMotionTest, ANewRequestFindsTheRobotAtItsStart) {
  GateHarness h = Ready();
  h.Pose({10, 1});
  h.request_id = 2;
  EXPECT_EQ(DeploymentsOf(h.Baseline(kStraight)).size(), 2u);
  EXPECT_EQ(CodeOf(h.Advise({{0, 1}, {1, 0}, {28, 0}, {29, 1}})),
            Code::kAccepted);
}

TEST(GateMotionTest, AMapUpdateKeepsRouteAndPlace) {
  GateHarness h = Ready();
  h.Pose({10, 1});
  h.Map(MapFromAscii({"111111111111111111111111111111",
                      "144444444444444444444444444441",
                      "111111111111111111111111111111"}));
  h.Baseline(kStraight);
  EXPECT_EQ(CodeOf(h.gate.On(
                h.AdviceFrom(9, {9, 1}, {{9, 1}, {10, 0}, {28, 0}, {29, 1}}))),
            Code::kLate);
  EXPECT_EQ(CodeOf(h.gate.On(h.AdviceFrom(
                10, {10, 1}, {{10, 1}, {11, 0}, {28, 0}, {29, 1}}))),
            Code::kAccepted);
}

}  // namespace
}  // namespace terra::verifier

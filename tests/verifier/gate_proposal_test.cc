// What the gate makes of a proposal whose key is right.
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/verifier/gate_field.h"
#include "verifier/gate.h"

namespace terra::verifier {
namespace {

using ::testing::IsEmpty;
using testing::MapFromAscii;

// ---- Every code of a proposal. ----

TEST(GateTest, EachFaultOfAProposalHasItsCode) {
  struct Row {
    const char* name;
    Route route;
    Code code;
    int segment;
    Cell cell;
  };
  const Row rows[] = {
      {"one waypoint", {{0, 1}}, Code::kTooFewWaypoints, -1, {}},
      {"start", {{1, 1}, {5, 1}}, Code::kStartMismatch, 0, {1, 1}},
      {"goal", {{0, 1}, {4, 1}}, Code::kGoalMismatch, 0, {4, 1}},
      {"outside", {{0, 1}, {0, -1}, {5, 1}}, Code::kOutOfBounds, 0, {0, -1}},
      {"obstacle", {{0, 1}, {0, 3}, {5, 1}}, Code::kObstacle, 0, {0, 3}},
      {"equal", kStraight, Code::kNotCheaper, -1, {}},
  };
  for (const Row& row : rows) {
    GateHarness h;
    h.Map(MapFromAscii({"111111", "199991", "111111", "#11111"}));
    h.Request(1);
    h.Baseline(kStraight);
    const Deployed before = h.deployed();
    const Decisions out = h.Advise(row.route);
    ASSERT_EQ(out.size(), 1u) << row.name;
    const Verdict& verdict = std::get<Verdict>(out[0]);
    EXPECT_EQ(CodeName(verdict.code), CodeName(row.code)) << row.name;
    EXPECT_EQ(verdict.fail_segment, row.segment) << row.name;
    EXPECT_EQ(verdict.fail_cell, row.cell) << row.name;
    EXPECT_EQ(h.deployed(), before) << row.name;
  }
}

TEST(GateTest, TheBusLimitsHoldForProposals) {
  GateHarness h = Ready();
  Route route = kTop;
  route.insert(route.begin(), 2'048 - kTop.size(), route.front());
  Route too_many = route;
  too_many.insert(too_many.begin(), route.front());
  EXPECT_EQ(CodeOf(h.Advise(too_many)), Code::kWorkLimit);
  EXPECT_EQ(CodeOf(h.Advise(route)), Code::kAccepted);
}

TEST(GateTest, NotBestIsCheaperThanTheBaselineOnly) {
  GateHarness h = Ready();
  h.Advise(kTop);
  EXPECT_EQ(CodeOf(h.Advise(kCorners)), Code::kNotBest);
  EXPECT_EQ(CodeOf(h.Advise(kBottom)), Code::kNotBest) << "an equal cost";
  EXPECT_EQ(CodeOf(h.Advise(kStraight)), Code::kNotCheaper);
  EXPECT_EQ(h.deployed().waypoints, kTop);
}

TEST(GateTest, AnswersWithoutARouteAreJudgedToo) {
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceOf({});
  advice.kind = AdviceKind::kRetain;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kRetained);
  advice = h.AdviceOf({});
  advice.kind = AdviceKind::kMalformed;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kParseError);
  EXPECT_EQ(h.deployed().mode, Mode::kBaseline);
}

TEST(GateTest, AnUnknownKindIsMalformedBeforeAnythingElse) {
  GateHarness h = Ready();
  for (const int kind : {0, 5, -1, 127}) {
    AdviceEvent advice = h.AdviceOf(kTop);
    advice.kind = static_cast<AdviceKind>(kind);
    EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kMalformedMessage) << kind;
  }
  AdviceEvent stale = h.AdviceOf(kTop);
  stale.kind = AdviceKind::kNone;
  h.Request(2);
  EXPECT_EQ(CodeOf(h.gate.On(stale)), Code::kMalformedMessage);
}

TEST(GateTest, AnAdvisorWithoutAnAnswerGetsNoVerdict) {
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceOf(kTop);
  advice.kind = AdviceKind::kFailed;
  EXPECT_THAT(h.gate.On(advice), IsEmpty());
  EXPECT_EQ(h.gate.counters().failed_advice, 1);
  EXPECT_EQ(h.gate.counters().judged, 0);
}

TEST(GateTest, AnAnchorOffTheStartIsRefused) {
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceOf(kTop);
  advice.anchor.cell = {1, 1};
  const auto verdicts = VerdictsOf(h.gate.On(advice));
  ASSERT_EQ(verdicts.size(), 1u);
  EXPECT_EQ(verdicts[0].code, Code::kStartMismatch);
  EXPECT_EQ(verdicts[0].fail_cell, (Cell{1, 1}));
}

// ---- Thresholds. ----

// The way above costs `gain` less than the baseline below.
Code CodeForGain(double gain, double margin) {
  ByteRaster ids(2, 2);
  ids << 0, 1, 0, 0;
  Legend legend = Legend::Create({{0, "ground", 1, {0, 0, 0}},
                                  {1, "better", 1 - gain, {1, 1, 1}}})
                      .value();
  GateHarness h(margin);
  h.start = {0, 0};
  h.goal = {1, 1};
  h.Map(TerrainMap::Create(ids, std::move(legend)).value());
  h.Request(1);
  h.Baseline({{0, 0}, {0, 1}, {1, 1}});
  return CodeOf(h.Advise({{0, 0}, {1, 0}, {1, 1}}));
}

TEST(GateTest, StrictlyCheaperMeansByMoreThanEpsilon) {
  EXPECT_EQ(CodeForGain(1.1e-6, 0), Code::kAccepted);
  EXPECT_EQ(CodeForGain(0.9e-6, 0), Code::kNotCheaper);
  EXPECT_EQ(CodeForGain(-1.1e-6, 0), Code::kNotCheaper);
}

TEST(GateTest, BothSidesOfTheMargin) {
  EXPECT_EQ(CodeForGain(0.26, 0.25), Code::kAccepted);
  EXPECT_EQ(CodeForGain(0.24, 0.25), Code::kBelowMargin);
  EXPECT_EQ(CodeForGain(0.25, 0.25), Code::kBelowMargin);
}

// The first candidate saves 0.5, the second a little more than the first.
TEST(GateTest, BothSidesOfEpsilonAgainstTheDeployedRoute) {
  for (const double gain : {1.1e-6, 0.9e-6}) {
    const double cost = 1 - gain / std::numbers::sqrt2;  // entered diagonally
    ByteRaster ids(3, 3);
    ids << 0, 1, 0, 0, 0, 0, 0, 2, 0;
    Legend legend = Legend::Create({{0, "ground", 2, {0, 0, 0}},
                                    {1, "good", 1, {1, 1, 1}},
                                    {2, "better", cost, {2, 2, 2}}})
                        .value();
    GateHarness h;
    h.start = {0, 1};
    h.goal = {2, 1};
    h.Map(TerrainMap::Create(ids, std::move(legend)).value());
    h.Request(1);
    h.Baseline({{0, 1}, {0, 0}, {1, 1}, {2, 0}, {2, 1}});
    EXPECT_EQ(CodeOf(h.Advise({{0, 1}, {1, 0}, {2, 1}})), Code::kAccepted);
    EXPECT_EQ(CodeOf(h.Advise({{0, 1}, {1, 2}, {2, 1}})),
              gain > kEpsilon ? Code::kAccepted : Code::kNotBest);
  }
}

}  // namespace
}  // namespace terra::verifier

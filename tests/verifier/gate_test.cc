#include "verifier/gate.h"

#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/ascii_map.h"
#include "tests/verifier/gate_harness.h"

namespace terra::verifier {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::MapFromAscii;

// The straight baseline costs 37, the detour along the top 3 + 2 sqrt 2, the
// one over the corners 7.
TerrainMap Field() {
  return MapFromAscii({"111111", "199991", "111111"});
}
const Route kStraight = {{0, 1}, {5, 1}};
const Route kTop = {{0, 1}, {1, 0}, {4, 0}, {5, 1}};
const Route kBottom = {{0, 1}, {1, 2}, {4, 2}, {5, 1}};
const Route kCorners = {{0, 1}, {0, 0}, {5, 0}, {5, 1}};

// A gate that has deployed the straight baseline of request 1.
GateHarness Ready() {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.Baseline(kStraight);
  return h;
}

// ---- The way to a route. ----

TEST(GateTest, DeploysTheBaselineAtOnce) {
  GateHarness h;
  EXPECT_THAT(h.Map(Field()), IsEmpty());
  const auto asked = DeploymentsOf(h.Request(1));
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].mode, Mode::kNone);
  EXPECT_EQ(asked[0].cause, Cause::kNewRequest);
  const Decisions out = h.Baseline(kStraight);
  ASSERT_EQ(out.size(), 1u);
  const Deployed& deployed = std::get<Deployed>(out[0]);
  EXPECT_EQ(deployed, h.deployed());
  EXPECT_EQ(deployed.mode, Mode::kBaseline);
  EXPECT_EQ(deployed.cause, Cause::kNewBaseline);
  EXPECT_EQ(deployed.request_id, 1);
  EXPECT_EQ(deployed.start, h.start);
  EXPECT_EQ(deployed.goal, h.goal);
  EXPECT_EQ(deployed.map_id, h.map_id);
  EXPECT_EQ(deployed.baseline_digest, h.baseline_digest);
  EXPECT_EQ(deployed.source, "planner");
  EXPECT_EQ(deployed.source_session, 500);
  EXPECT_EQ(deployed.waypoints, kStraight);
  EXPECT_EQ(deployed.cost, 37);
  EXPECT_EQ(deployed.baseline_cost, 37);
}

TEST(GateTest, RepeatedBaselinesAreSilent) {
  GateHarness h = Ready();
  EXPECT_THAT(h.Baseline(kStraight), IsEmpty());
  EXPECT_THAT(h.Request(1), IsEmpty());
}

TEST(GateTest, UpgradesToACheaperProposal) {
  GateHarness h = Ready();
  const std::int64_t before = h.deployed().route_seq;
  const Decisions out = h.Advise(kTop);
  ASSERT_EQ(out.size(), 2u);
  const Verdict& verdict = std::get<Verdict>(out[0]);
  EXPECT_EQ(verdict.code, Code::kAccepted);
  EXPECT_EQ(verdict.subject, Subject::kAdvice);
  EXPECT_EQ(verdict.request_id, 1);
  EXPECT_EQ(verdict.map_id, h.map_id);
  EXPECT_EQ(verdict.baseline_digest, h.baseline_digest);
  EXPECT_EQ(verdict.advisor, "search");
  EXPECT_EQ(verdict.advisor_session, 900);
  EXPECT_EQ(verdict.attempt, 1);
  EXPECT_EQ(verdict.candidate, 1);
  EXPECT_NEAR(verdict.candidate_cost, 5.8284, 1e-4);
  EXPECT_EQ(verdict.baseline_cost, 37);
  EXPECT_EQ(verdict.cost_to_beat, 37);
  EXPECT_EQ(verdict.route_seq_before, before);
  const Deployed& deployed = std::get<Deployed>(out[1]);
  EXPECT_EQ(deployed.mode, Mode::kCandidate);
  EXPECT_EQ(deployed.cause, Cause::kUpgrade);
  EXPECT_EQ(deployed.route_seq, before + 1);
  EXPECT_EQ(deployed.decision, verdict.decision + 1);
  EXPECT_EQ(deployed.source, "search");
  EXPECT_EQ(deployed.source_session, 900);
  EXPECT_EQ(deployed.source_attempt, 1);
  EXPECT_EQ(deployed.source_candidate, 1);
  EXPECT_EQ(deployed.waypoints, kTop);
  EXPECT_EQ(deployed.cost, verdict.candidate_cost);
  EXPECT_EQ(deployed.baseline_cost, 37);
  EXPECT_EQ(deployed, h.deployed());
}

TEST(GateTest, SeveralAdvisorsMayImproveInTurn) {
  GateHarness h = Ready();
  EXPECT_EQ(CodeOf(h.Advise(kCorners)), Code::kAccepted);
  EXPECT_EQ(CodeOf(h.Advise(kTop)), Code::kAccepted);
  EXPECT_EQ(h.deployed().waypoints, kTop);
}

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

// ---- Keys. ----

TEST(GateTest, AdviceForAReplacedRequestIsStale) {
  GateHarness h = Ready();
  const AdviceEvent old = h.AdviceOf(kTop);
  h.Request(2);
  h.Baseline(kStraight);
  const Deployed before = h.deployed();
  EXPECT_EQ(CodeOf(h.gate.On(old)), Code::kStaleRequest);
  EXPECT_EQ(h.deployed(), before);
}

TEST(GateTest, AdviceForAReplacedMapIsStale) {
  GateHarness h = Ready();
  const AdviceEvent old = h.AdviceOf(kTop);
  h.Map(MapFromAscii({"111111", "199991", "111112"}));
  const Deployed before = h.deployed();
  EXPECT_EQ(CodeOf(h.gate.On(old)), Code::kStaleMap);
  EXPECT_EQ(h.deployed(), before);
}

TEST(GateTest, AdviceForAReplacedBaselineIsStale) {
  GateHarness h = Ready();
  const AdviceEvent old = h.AdviceOf(kTop);
  h.Baseline(kCorners);
  const Deployed before = h.deployed();
  EXPECT_EQ(CodeOf(h.gate.On(old)), Code::kStaleBaseline);
  EXPECT_EQ(h.deployed(), before);
}

TEST(GateTest, AdviceForWhatTheGateNeverHeldWaits) {
  GateHarness h = Ready();
  const AdviceEvent good = h.AdviceOf(kTop);
  AdviceEvent other = good;
  other.request_id = 77;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  other = good;
  other.map_id = 77;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  other = good;
  other.baseline_digest = 77;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  EXPECT_EQ(h.gate.counters().unknown_key, 3);
  EXPECT_EQ(CodeOf(h.gate.On(good)), Code::kAccepted);
}

TEST(GateTest, AdviceThatOvertookItsBaselineIsJudgedWhenRepeated) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.baseline_digest = h.BaselineOf(kStraight).baseline_digest;
  const AdviceEvent early = h.AdviceOf(kTop);
  EXPECT_THAT(h.gate.On(early), IsEmpty());
  h.Baseline(kStraight);
  EXPECT_EQ(CodeOf(h.gate.On(early)), Code::kAccepted);
}

TEST(GateTest, AdviceBeforeAnythingIsHarmless) {
  GateHarness h;
  EXPECT_THAT(h.Advise(kTop), IsEmpty());
  EXPECT_EQ(h.gate.counters().unknown_key, 1);
  EXPECT_EQ(h.deployed(), Deployed{});
}

TEST(GateTest, JudgedAdviceGetsExactlyOneVerdict) {
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceOf(kTop);
  EXPECT_EQ(h.gate.On(advice).size(), 2u);
  EXPECT_THAT(h.gate.On(advice), IsEmpty());
  advice.waypoints = kBottom;
  EXPECT_THAT(h.gate.On(advice), IsEmpty()) << "same attempt, other content";
  EXPECT_EQ(h.gate.counters().repeats, 2);
  advice.candidate = 2;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest);
  advice.attempt += 1;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest);
  advice.session += 1;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest);
}

TEST(GateTest, AFloodDoesNotMakeRepeatedAdviceNew) {
  GateHarness h = Ready();
  const AdviceEvent steady = h.AdviceOf(kTop);
  EXPECT_EQ(CodeOf(h.gate.On(steady)), Code::kAccepted);
  for (int i = 0; i < 20'000; ++i) {
    h.Advise({{0, 1}});
    if (i % 1'000 == 0) {
      ASSERT_THAT(h.gate.On(steady), IsEmpty());
    }
  }
  EXPECT_EQ(h.gate.counters().judged, 20'001);
  EXPECT_EQ(h.gate.counters().accepted, 1);
}

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
  EXPECT_EQ(h.deployed(), Deployed{});
}

TEST(GateTest, CancelWithdrawsTheRouteForGood) {
  GateHarness h = Ready();
  const AdviceEvent advice = h.AdviceOf(kTop);
  const auto out = DeploymentsOf(h.Cancel(1));
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].mode, Mode::kNone);
  EXPECT_EQ(out[0].cause, Cause::kCancelled);
  EXPECT_EQ(out[0].request_id, 1);
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
  h.map_id = MapId(Field());
  h.Request(1);
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

// ---- Map updates. ----

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

TEST(GateTest, AMapMustBeThere) {
  Gate gate;
  EXPECT_FALSE(gate.has_map());
  EXPECT_THROW(gate.On(MapEvent{nullptr, 1}), std::logic_error);
}

// ---- Bookkeeping. ----

TEST(GateTest, DecisionsAreCountedOneByOne) {
  GateHarness h;
  h.Map(Field());
  std::vector<std::int64_t> numbers;
  const auto note = [&numbers](const Decisions& out) {
    for (const Decision& decision : out) {
      std::visit(
          [&numbers](const auto& d) {
            numbers.push_back(d.decision);
          },
          decision);
    }
  };
  note(h.Request(1));
  note(h.Baseline(kStraight));
  note(h.Advise(kStraight));
  note(h.Advise(kTop));
  EXPECT_THAT(numbers, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(h.deployed().route_seq, 3);
  EXPECT_EQ(h.gate.counters().judged, 2);
  EXPECT_EQ(h.gate.counters().accepted, 1);
}

}  // namespace
}  // namespace terra::verifier

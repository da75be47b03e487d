// How a route comes to be deployed, and what the gate says about it.
#include "verifier/gate.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/verifier/gate_field.h"

namespace terra::verifier {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

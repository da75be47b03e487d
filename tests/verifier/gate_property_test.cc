// The invariants of docs/gate.md on random event sequences, judged by an exact
// oracle. Each property plays TERRA_GATE_SEQUENCES sequences; RC_PARAMS sets
// rapidcheck's own parameters, for example "seed=1".

#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "terrain/digest.h"
#include "tests/verifier/gate_oracle.h"
#include "tests/verifier/gate_trace.h"
#include "verifier/gate_core.h"
#include "verifier/verify.h"

namespace terra::verifier {
namespace {

// Must be set before the first property runs.
const bool kConfigured = [] {
  const char* sequences = std::getenv("TERRA_GATE_SEQUENCES");
  const std::string count = sequences != nullptr ? sequences : "5000";
  const std::string params = "seed=20 max_success=" + count;
  return setenv("RC_PARAMS", params.c_str(), /*overwrite=*/0) == 0;
}();

std::vector<std::uint32_t> AnySequence() {
  const auto any = rc::gen::resize(
      rc::kNominalSize, rc::gen::inRange<std::uint32_t>(0, 4'000'000'000u));
  return *rc::gen::container<std::vector<std::uint32_t>>(any);
}

std::vector<Turn> AnyTrace() {
  return PlayTrace(AnySequence());
}

std::vector<Deployed> Deployments(const Decisions& decisions) {
  std::vector<Deployed> deployments;
  for (const Decision& decision : decisions) {
    if (const auto* deployed = std::get_if<Deployed>(&decision)) {
      deployments.push_back(*deployed);
    }
  }
  return deployments;
}

const Verdict* AdviceVerdict(const Turn& turn) {
  for (const Decision& decision : turn.decisions) {
    const auto* verdict = std::get_if<Verdict>(&decision);
    if (verdict != nullptr && verdict->subject == Subject::kAdvice) {
      return verdict;
    }
  }
  return nullptr;
}

bool Accepted(const Turn& turn) {
  const Verdict* verdict = AdviceVerdict(turn);
  return verdict != nullptr && verdict->code == Code::kAccepted;
}

bool SameCost(double a, const ExactCost& b) {
  return std::abs(a - b.value()) <= 1e-9;
}

// ---- Invariant 1. ----

RC_GTEST_PROP(GatePropertyTest, AValidBaselineMeansThatARouteIsDeployed, ()) {
  for (const Turn& turn : AnyTrace()) {
    if (turn.after.baseline_valid()) {
      RC_ASSERT(turn.after.deployed.has_route());
    }
  }
}

// ---- Invariant 2. ----

RC_GTEST_PROP(GatePropertyTest, DeployedRoutesAreFeasibleOnTheMapTheyName, ()) {
  for (const Turn& turn : AnyTrace()) {
    const Deployed& deployed = turn.after.deployed;
    RC_ASSERT(deployed.has_route() == !deployed.waypoints.empty());
    if (!deployed.has_route()) {
      RC_ASSERT(deployed.cost == kImpassable);
      continue;
    }
    RC_ASSERT(deployed.map_id == turn.after.map_id);
    const OracleCheck check = CheckDeployed(turn.after);
    RC_ASSERT(check.feasible());
    RC_ASSERT(SameCost(deployed.cost, check.cost));
  }
}

// ---- Invariant 3. ----

RC_GTEST_PROP(GatePropertyTest, NothingDeployedIsDearerThanTheBaseline, ()) {
  for (const Turn& turn : AnyTrace()) {
    const Observed& now = turn.after;
    if (now.deployed.has_route() && now.baseline_valid()) {
      RC_ASSERT(
          !ExactlyCheaper(now.baseline_check.cost, CheckDeployed(now).cost));
    }
    if (Accepted(turn)) {
      RC_ASSERT(now.baseline_valid());
      RC_ASSERT(
          ExactlyCheaper(CheckDeployed(now).cost, now.baseline_check.cost));
      RC_ASSERT(SameCost(now.deployed.baseline_cost, now.baseline_check.cost));
    }
  }
}

// ---- Invariant 4. ----

RC_GTEST_PROP(GatePropertyTest, TheDeployedCostNeverRises, ()) {
  for (const Turn& turn : AnyTrace()) {
    const Deployed& before = turn.before.deployed;
    const Deployed& after = turn.after.deployed;
    if (before.route_seq == after.route_seq) {
      RC_ASSERT(before == after);
      continue;
    }
    RC_ASSERT(after.route_seq > before.route_seq);
    const bool same = before.request_id == after.request_id &&
                      before.map_id == after.map_id && !turn.after.cancelled();
    if (same && before.has_route()) {
      RC_ASSERT(after.has_route());
      RC_ASSERT(ExactlyCheaper(CheckDeployed(turn.after).cost,
                               CheckDeployed(turn.before).cost));
    }
  }
}

// ---- Invariant 5. ----

std::vector<Deployed> Replay(const std::vector<Turn>& trace,
                             bool with_refused_advice) {
  Gate gate{kTraceOptions};
  std::vector<Deployed> deployments;
  for (const Turn& turn : trace) {
    const bool advice = std::holds_alternative<AdviceEvent>(turn.event);
    if (advice && !with_refused_advice && !Accepted(turn)) continue;
    for (Deployed deployed : Deployments(Feed(gate, turn.event))) {
      deployed.decision = 0;  // counts verdicts too
      deployments.push_back(std::move(deployed));
    }
  }
  return deployments;
}

RC_GTEST_PROP(GatePropertyTest, RefusedAdviceLeavesNoTrace, ()) {
  const std::vector<Turn> trace = AnyTrace();
  RC_ASSERT(Replay(trace, true) == Replay(trace, false));
  for (const Turn& turn : trace) {
    if (std::holds_alternative<AdviceEvent>(turn.event) && !Accepted(turn)) {
      RC_ASSERT(turn.before.deployed == turn.after.deployed);
    }
  }
}

// ---- Invariant 6. ----

RC_GTEST_PROP(GatePropertyTest, TheSameEventsGiveTheSameDecisions, ()) {
  Gate gate{kTraceOptions};
  for (const Turn& turn : AnyTrace()) {
    RC_ASSERT(Feed(gate, turn.event) == turn.decisions);
  }
}

GateState StateOf(const Gate& gate, std::shared_ptr<const TerrainMap> map) {
  GateState state;
  state.request = gate.request();
  state.answered_by = gate.answered_by();
  state.map = std::move(map);
  state.map_id = gate.map_id();
  if (gate.baseline() != nullptr) state.baseline = *gate.baseline();
  state.deployed = gate.deployed();
  state.place = gate.driven().place();
  state.on_route = gate.driven().on_route();
  state.decisions = gate.decisions();
  return state;
}

Decisions FeedGiven(Gate& gate, const Event& event, Lookup lookup) {
  const auto* advice = std::get_if<AdviceEvent>(&event);
  return advice != nullptr ? gate.OnGiven(*advice, lookup) : Feed(gate, event);
}

// The core is all that decides, and the digest is all of the core: so a step of
// the journal can be checked without the steps before it.
RC_GTEST_PROP(GatePropertyTest, FromTheSameCoreFollowsTheSame, ()) {
  Gate gate{kTraceOptions};
  for (const Turn& turn : AnyTrace()) {
    std::optional<Gate> other =
        Gate::GoOnFrom(kTraceOptions, StateOf(gate, turn.before.map));
    RC_ASSERT(other.has_value());
    const std::int64_t before = CoreDigest(gate);
    RC_ASSERT(CoreDigest(*other) == before);
    const Decisions decisions = Feed(gate, turn.event);
    const bool is_step = !decisions.empty() || CoreDigest(gate) != before;
    if (!is_step) continue;
    RC_ASSERT(FeedGiven(*other, turn.event, gate.lookup()) == decisions);
    RC_ASSERT(CoreDigest(*other) == CoreDigest(gate));
  }
}

// ---- Invariant 7 (bounded time: the limits of CheckRouteTest). ----

RC_GTEST_PROP(GatePropertyTest, AnEventGivesAtMostThreeDecisions, ()) {
  std::int64_t decision = 0;
  for (const Turn& turn : AnyTrace()) {
    RC_ASSERT(turn.decisions.size() <= 3u);
    for (const Decision& d : turn.decisions) {
      const std::int64_t number = std::visit(
          [](const auto& value) {
            return value.decision;
          },
          d);
      RC_ASSERT(number == decision + 1);
      decision = number;
    }
  }
}

// ---- Invariant 8. ----

RC_GTEST_PROP(GatePropertyTest, OnlyWhatThePlannerSaidIsDeployedAsBaseline,
              ()) {
  std::map<std::int64_t, BaselineEvent> said;
  for (const Turn& turn : AnyTrace()) {
    if (const auto* event = std::get_if<BaselineEvent>(&turn.event)) {
      const bool honest =
          event->baseline_digest ==
          BaselineDigest(event->request_id, event->map_id, event->waypoints);
      if (honest) said[event->baseline_digest] = *event;
    }
    const Deployed& deployed = turn.after.deployed;
    if (deployed.mode == Mode::kBaseline) {
      const auto found = said.find(deployed.baseline_digest);
      RC_ASSERT(found != said.end());
      RC_ASSERT(found->second.request_id == deployed.request_id);
      RC_ASSERT(found->second.waypoints == deployed.waypoints);
    }
  }
}

// Whoever checks a DEPLOYED looks up the baseline that it names.
RC_GTEST_PROP(GatePropertyTest, TheBaselineThatIsNamedCostsWhatIsSaid, ()) {
  std::map<std::int64_t, BaselineEvent> said;
  std::map<std::int64_t, std::shared_ptr<const TerrainMap>> maps;
  for (const Turn& turn : AnyTrace()) {
    if (const auto* event = std::get_if<MapEvent>(&turn.event)) {
      maps[event->map_id] = event->map;
    }
    if (const auto* event = std::get_if<BaselineEvent>(&turn.event)) {
      const bool honest =
          event->baseline_digest ==
          BaselineDigest(event->request_id, event->map_id, event->waypoints);
      if (honest) said[event->baseline_digest] = *event;
    }
    for (const Deployed& deployed : Deployments(turn.decisions)) {
      if (!deployed.has_route()) continue;
      if (deployed.baseline_digest == 0) {
        RC_ASSERT(deployed.mode == Mode::kCandidate);
        RC_ASSERT(deployed.baseline_cost == kImpassable);
        continue;
      }
      const auto found = said.find(deployed.baseline_digest);
      RC_ASSERT(found != said.end());
      const RouteCheck check =
          CheckRoute(*maps.at(deployed.map_id), found->second.waypoints,
                     deployed.start, deployed.goal, kBusLimits);
      RC_ASSERT(deployed.baseline_cost == check.cost);
    }
  }
}

RC_GTEST_PROP(GatePropertyTest, AnInvalidBaselineIsReportedOnce, ()) {
  for (const Turn& turn : AnyTrace()) {
    const auto* event = std::get_if<BaselineEvent>(&turn.event);
    const bool held = event != nullptr && turn.after.baseline &&
                      event->has_route && event->map_id == turn.after.map_id &&
                      event->request_id == turn.after.deployed.request_id &&
                      !turn.after.cancelled();
    if (!held) continue;
    const bool repeated =
        turn.before.baseline &&
        turn.before.deployed.request_id == event->request_id &&
        turn.before.baseline->baseline_digest == event->baseline_digest &&
        turn.before.baseline->map_id == event->map_id &&
        turn.before.baseline->waypoints == event->waypoints;
    std::vector<Code> codes;
    for (const Decision& decision : turn.decisions) {
      const auto* verdict = std::get_if<Verdict>(&decision);
      if (verdict == nullptr) continue;
      RC_ASSERT(verdict->subject == Subject::kBaseline);
      codes.push_back(verdict->code);
    }
    const bool report = !repeated && !turn.after.baseline_valid();
    RC_ASSERT(codes == (report ? std::vector{turn.after.baseline_check.code}
                               : std::vector<Code>{}));
  }
}

// ---- Invariant 9: the verdict is exactly the oracle's. ----

// With the way up to the anchor, advice close to the waypoint limit may come to
// lie above it; gate_motion_test has the exact limit.
bool MayExceedLimit(const AdviceEvent& advice) {
  return advice.anchor.index > 0 && advice.waypoints.size() <= 2'048 &&
         advice.waypoints.size() +
                 static_cast<std::size_t>(advice.anchor.index) >
             2'048;
}

bool IsStale(Code code) {
  return code == Code::kStaleRequest || code == Code::kStaleMap ||
         code == Code::kStaleBaseline;
}

RC_GTEST_PROP(GatePropertyTest, EachVerdictIsTheOracles, ()) {
  for (const Turn& turn : AnyTrace()) {
    const auto* advice = std::get_if<AdviceEvent>(&turn.event);
    if (advice == nullptr) continue;
    const Verdict* verdict = AdviceVerdict(turn);
    if (turn.repeat || advice->kind == AdviceKind::kFailed) {
      RC_ASSERT(turn.decisions.empty());
      continue;
    }
    const auto kind = static_cast<int>(advice->kind);
    const bool known_kind = kind >= 1 && kind <= 3;
    if (!SpeaksOfWhatIsInForce(turn.before, *advice)) {
      if (verdict != nullptr) {
        const bool refused = known_kind
                                 ? IsStale(verdict->code)
                                 : verdict->code == Code::kMalformedMessage;
        RC_ASSERT(refused);
      }
      continue;
    }
    const bool judged = verdict != nullptr;
    RC_ASSERT(judged);
    const Code expected = known_kind ? OracleVerdict(turn.before, *advice)
                                     : Code::kMalformedMessage;
    if (verdict->code == Code::kWorkLimit && MayExceedLimit(*advice)) continue;
    RC_ASSERT(CodeName(verdict->code) == CodeName(expected));
    if (expected == Code::kAccepted) {
      RC_ASSERT(turn.after.deployed.mode == Mode::kCandidate);
      const bool joined =
          OracleCells(*turn.after.map, turn.after.deployed.waypoints) ==
          OracleCells(*turn.before.map, Joined(turn.before, *advice));
      RC_ASSERT(joined);
    }
  }
}

}  // namespace
}  // namespace terra::verifier

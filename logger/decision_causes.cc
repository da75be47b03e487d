#include "logger/decision_causes.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "verifier/gate_codec.h"

namespace terra::logger {
namespace {

using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::verdict_t;
using verifier::BaselineEvent;

std::string Missing(const char* what, std::int64_t name) {
  return std::string("the log does not hold ") + what + " " +
         std::to_string(name);
}

// Makes the gate take a planner for the one that answers the current request.
BaselineEvent AnswerOf(std::int64_t planner, std::int64_t request_id) {
  BaselineEvent answer;
  answer.session = planner;
  answer.request_id = request_id;
  return answer;  // For map 0, so that nothing else comes of it.
}

BaselineEvent NoBaseline(std::int64_t request_id, std::int64_t map_id) {
  BaselineEvent none;
  none.request_id = request_id;
  none.map_id = map_id;
  return none;
}

}  // namespace

std::int64_t Difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) -
                                   static_cast<std::uint64_t>(b));
}

Ways DecisionCauses::WaysTo(const Logged<LogContents::Decided>& decision,
                            const ReplayedGate& gate,
                            std::int64_t route_seq_offset) {
  gate_ = &gate;
  route_seq_offset_ = route_seq_offset;
  index_ = decision.index;
  Ways ways;
  std::visit(
      [&](const auto& message) {
        decision_ = message.decision;
        WaysTo(message, ways);
      },
      decision.message);
  return ways;
}

void DecisionCauses::Add(std::initializer_list<Step> steps, Ways& ways) {
  GateEvents way;
  for (const Step& step : steps) {
    if (!step) return;
    way.insert(way.end(), step->begin(), step->end());
  }
  ways.all.push_back(std::move(way));
}

// ---- To a deployment ----

void DecisionCauses::WaysTo(const deployed_t& deployed, Ways& ways) {
  const std::int64_t digest = deployed.baseline_digest;
  switch (deployed.cause) {
    case deployed_t::CAUSE_NEW_REQUEST:
      return Add({Map(deployed.map_id, ways), Request(deployed, ways)}, ways);
    case deployed_t::CAUSE_CANCELLED:
      return WaysToCancelled(deployed, ways);
    case deployed_t::CAUSE_NO_ROUTE: {
      const Step map = Map(deployed.map_id, ways);
      for (const Logged<baseline_t>& said : contents_.other_baselines) {
        if (said.message.request_id == deployed.request_id &&
            said.message.map_id == deployed.map_id &&
            said.message.status != baseline_t::STATUS_CANCELLED) {
          return Add({map, GateEvents{verifier::ToEvent(said.message)}}, ways);
        }
      }
      ways.missing =
          Missing("a BASELINE without a route of request", deployed.request_id);
      return;
    }
    case deployed_t::CAUSE_NEW_BASELINE:
      return Add({Map(deployed.map_id, ways),
                  Baseline(digest, deployed.source_session, ways)},
                 ways);
    case deployed_t::CAUSE_MAP_UPDATE:
    case deployed_t::CAUSE_REVERT_BLOCKED:
    case deployed_t::CAUSE_REVERT_NOT_CHEAPER:
    case deployed_t::CAUSE_BASELINE_INVALID:
      return WaysToNewMap(deployed, ways);
    default:
      return;  // An upgrade follows from its verdict, or from nothing.
  }
}

void DecisionCauses::WaysToCancelled(const deployed_t& deployed, Ways& ways) {
  const std::int64_t id = deployed.request_id;
  const Step map = Map(deployed.map_id, ways);
  const bool current = id == gate_->deployed().request_id;
  const auto cancel = contents_.cancels.find(id);
  if (current && cancel != contents_.cancels.end()) {
    Add({map, GateEvents{verifier::ToEvent(cancel->second.message)}}, ways);
  }
  // The planner heard of it, and carries it on.
  for (const Logged<baseline_t>& said : contents_.other_baselines) {
    const baseline_t& message = said.message;
    if (message.request_id != id ||
        message.status != baseline_t::STATUS_CANCELLED) {
      continue;
    }
    GateEvents events;
    if (!current && gate_->deployed().request_id != 0) {
      events.emplace_back(
          AnswerOf(message.session, gate_->deployed().request_id));
    }
    events.emplace_back(verifier::ToEvent(message));
    Add({map, events}, ways);
    return;
  }
  if (ways.all.empty()) ways.missing = Missing("the end of request", id);
}

void DecisionCauses::WaysToNewMap(const deployed_t& deployed, Ways& ways) {
  const Step map = Map(deployed.map_id, ways);
  if (deployed.map_id == gate_->map_id()) return;  // There is no new one.
  Add({map}, ways);
  const std::int64_t digest = deployed.baseline_digest;
  if (digest == gate_->baseline_digest()) return;
  if (digest == 0) {
    // The planner had said that there is no way.
    return Add(
        {GateEvents{NoBaseline(deployed.request_id, gate_->map_id())}, map},
        ways);
  }
  const std::int64_t planner = later_.PlannerOf(digest, decision_);
  Add({Baseline(digest, planner, ways), map}, ways);
}

// ---- To a verdict ----

void DecisionCauses::WaysTo(const verdict_t& verdict, Ways& ways) {
  if (verdict.subject == verdict_t::SUBJECT_BASELINE) {
    return WaysToBaselineVerdict(verdict, ways);
  }
  const auto found = contents_.advice.find(
      {verdict.request_id, verdict.map_id, verdict.baseline_digest,
       verdict.advisor_session, verdict.attempt, verdict.candidate});
  if (found == contents_.advice.end()) {
    ways.num_advice = 0;
    ways.missing = Missing("the ADVICE, attempt", verdict.attempt);
    return;
  }
  ways.num_advice = found->second.size();
  for (const Logged<terra_msg::advice_t>& said : found->second) {
    verifier::AdviceEvent event = verifier::ToEvent(said.message);
    if (event.anchor.session == session_) {
      event.anchor.route_seq =
          Difference(event.anchor.route_seq, route_seq_offset_);
    }
    const Step advice = GateEvents{event};
    // Advice that cannot be read gets that code whatever its key.
    const bool any_key = verdict.code == verdict_t::CODE_MALFORMED_MESSAGE;
    if (IsStale(verdict) || any_key) WaysToStale(verdict, advice, ways);
    if (!IsStale(verdict)) WaysToJudged(verdict, advice, ways);
  }
}

void DecisionCauses::WaysToBaselineVerdict(const verdict_t& verdict,
                                           Ways& ways) {
  const Step map = Map(verdict.map_id, ways);
  const Step baseline =
      Baseline(verdict.baseline_digest, verdict.advisor_session, ways);
  Add({map, baseline}, ways);
  if (verdict.map_id == gate_->map_id()) return;
  Add({map}, ways);            // It was held, and the new map blocks it.
  Add({baseline, map}, ways);  // The same, taken up without a decision.
}

void DecisionCauses::WaysToStale(const verdict_t& verdict, const Step& advice,
                                 Ways& ways) {
  Add({advice}, ways);
  const bool any_key = verdict.code == verdict_t::CODE_MALFORMED_MESSAGE;
  if (any_key || verdict.code == verdict_t::CODE_STALE_REQUEST) {
    // Cancelled before it was heard of.
    const auto cancel = contents_.cancels.find(verdict.request_id);
    if (cancel != contents_.cancels.end()) {
      Add({GateEvents{verifier::ToEvent(cancel->second.message)}, advice},
          ways);
    }
  }
  if (any_key || verdict.code == verdict_t::CODE_STALE_MAP) {
    if (verdict.map_id == gate_->map_id()) {
      Add({MapAfter(verdict.map_id, ways), advice}, ways);
    }
  }
  if (any_key || verdict.code == verdict_t::CODE_STALE_BASELINE) {
    WaysToStaleBaseline(verdict, advice, ways);
  }
}

// It was replaced by a baseline, or by the planner's word that there is none,
// and no decision said so.
void DecisionCauses::WaysToStaleBaseline(const verdict_t& verdict,
                                         const Step& advice, Ways& ways) {
  const std::int64_t digest = verdict.baseline_digest;
  const Step held = digest == gate_->baseline_digest()
                        ? GateEvents{}
                        : Baseline(digest, 0, ways);
  const std::int64_t next = later_.BaselineAfter(digest, decision_);
  if (next != 0) {
    Add({held, Baseline(next, later_.PlannerOf(next, decision_), ways), advice},
        ways);
  }
  const Logged<baseline_t>* said = nullptr;
  for (const auto& [name, one] : contents_.baselines) {
    if (name.digest != digest && one.index < index_ &&
        one.message.request_id == verdict.request_id &&
        one.message.map_id == verdict.map_id &&
        (said == nullptr || one.index > said->index)) {
      said = &one;
    }
  }
  if (said != nullptr) {
    Add({held, GateEvents{verifier::ToEvent(said->message)}, advice}, ways);
  }
  Add({held, GateEvents{NoBaseline(verdict.request_id, verdict.map_id)},
       advice},
      ways);
}

void DecisionCauses::WaysToJudged(const verdict_t& verdict, const Step& advice,
                                  Ways& ways) {
  Step state = GateEvents{};
  if (!HasCurrentKey(verdict)) {
    if (verdict.request_id != gate_->deployed().request_id) return;
    const std::int64_t digest = verdict.baseline_digest;
    const Step map = Map(verdict.map_id, ways);
    const Step baseline =
        Baseline(digest, later_.PlannerOf(digest, decision_), ways);
    if (!map || !baseline) return;
    state = *map;
    state->insert(state->end(), baseline->begin(), baseline->end());
  }
  Add({state, advice}, ways);  // Late by its route_seq, or not at all.
  const bool late = verdict.code == verdict_t::CODE_LATE;
  if (gate_->driven().Passed(verdict.anchor_index) != late) {
    Add({state, PosesFor(verdict, ways), advice}, ways);
  }
}

bool DecisionCauses::HasCurrentKey(const verdict_t& verdict) const {
  return verdict.request_id == gate_->deployed().request_id &&
         verdict.map_id == gate_->map_id() &&
         verdict.baseline_digest == gate_->baseline_digest();
}

// ---- Steps ----

DecisionCauses::Step DecisionCauses::Map(std::int64_t map_id, Ways& ways) {
  if (map_id == 0) return GateEvents{};
  const std::vector<std::int64_t> passing = MapsInPassing(map_id);
  if (map_id == gate_->map_id() && passing.empty()) return GateEvents{};
  const bus::MapPtr map = contents_.maps.Find(map_id);
  if (!map) {
    ways.missing = Missing("all of map", map_id);
    return std::nullopt;
  }
  const std::shared_ptr<const TerrainMap> terrain(map, &map->map);
  GateEvents events;
  for (const std::int64_t id : passing) {
    events.emplace_back(verifier::MapEvent{terrain, id});  // only named
  }
  events.emplace_back(verifier::MapEvent{terrain, map_id});
  return events;
}

// While there is no route, maps come and go without a decision; later verdicts
// call them stale.
std::vector<std::int64_t> DecisionCauses::MapsInPassing(
    std::int64_t map_id) const {
  std::vector<std::int64_t> passing;
  if (gate_->baseline_digest() != 0 || !gate_->deployed().waypoints.empty()) {
    return passing;
  }
  const std::vector<std::int64_t>& sequence = contents_.maps.sequence();
  for (const std::int64_t id : later_.ReplacedBefore(decision_).maps) {
    if (id != map_id && id != gate_->map_id() &&
        std::ranges::find(sequence, id) != sequence.end()) {
      passing.push_back(id);
    }
  }
  return passing;
}

// A map that was replaced without a decision: by the one decided on next, else
// by the one that the log has next.
DecisionCauses::Step DecisionCauses::MapAfter(std::int64_t map_id, Ways& ways) {
  const std::int64_t next = later_.MapAfter(map_id, decision_);
  if (next != 0) return Map(next, ways);
  const std::vector<std::int64_t>& sequence = contents_.maps.sequence();
  const auto last = std::find(sequence.rbegin(), sequence.rend(), map_id);
  if (last == sequence.rend() || last == sequence.rbegin()) {
    ways.missing = Missing("a map after map", map_id);
    return std::nullopt;
  }
  return Map(*std::prev(last), ways);
}

// The gate may have it from the planner.
DecisionCauses::Step DecisionCauses::Request(const deployed_t& deployed,
                                             Ways& ways) const {
  const auto found = contents_.requests.find(deployed.request_id);
  if (found != contents_.requests.end()) {
    return GateEvents{verifier::ToEvent(found->second.message)};
  }
  const auto carries_it = [&deployed](const baseline_t& message) {
    return message.request_id == deployed.request_id;
  };
  const baseline_t* carried = nullptr;
  for (const auto& [name, said] : contents_.baselines) {
    if (carries_it(said.message)) carried = &said.message;
  }
  for (const Logged<baseline_t>& said : contents_.other_baselines) {
    if (carries_it(said.message)) carried = &said.message;
  }
  if (carried == nullptr) {
    ways.missing = Missing("request", deployed.request_id);
    return std::nullopt;
  }
  return GateEvents{verifier::RequestEvent{
      deployed.request_id, false, Cell{carried->start_x, carried->start_y},
      Cell{carried->goal_x, carried->goal_y}}};
}

DecisionCauses::Step DecisionCauses::Baseline(std::int64_t digest,
                                              std::int64_t session,
                                              Ways& ways) const {
  const Logged<baseline_t>* found = contents_.FindBaseline(digest, session);
  if (found == nullptr) {
    ways.missing = Missing("baseline", digest);
    return std::nullopt;
  }
  return GateEvents{verifier::ToEvent(found->message)};
}

}  // namespace terra::logger

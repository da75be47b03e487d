#include "logger/gate_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bus/codec.h"
#include "terrain/digest.h"
#include "terrain/segment.h"
#include "verifier/gate_codec.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using verifier::AdviceEvent;
using verifier::BaselineEvent;
using verifier::MapEvent;
using verifier::RequestEvent;

using MapPtr = std::shared_ptr<const TerrainMap>;

MapPtr Terrain(const bus::MapPtr& map) {
  return map ? MapPtr(map, &map->map) : nullptr;
}

// The same route with steps to and fro at the goal, so that it costs more.
Route Dearer(const TerrainMap& map, Route route, double by) {
  const CellPath cells = RasterizeRoute(route);
  if (cells.size() < 2) return route;
  const Cell last = cells.back();
  const Cell before = cells[cells.size() - 2];
  const double there_and_back = map.Cost(before) + map.Cost(last);
  const double rounds = std::floor(by / there_and_back) + 1;
  const auto room =
      static_cast<double>(verifier::kBusLimits.max_waypoints - route.size());
  if (!(2 * rounds <= room)) return route;
  for (int i = 0; i < static_cast<int>(rounds); ++i) {
    route.push_back(before);
    route.push_back(last);
  }
  return route;
}

// Makes the events that bring a fresh gate to the state of one DEPLOYED.
class StateEvents {
 public:
  StateEvents(const deployed_t& deployed,
              const LaterDecisions::Replaced& replaced)
      : deployed_(deployed), replaced_(replaced) {}

  /// What was in force before counts by its name only: advice for it is stale.
  /// The baseline may have been found on a map before this one. It is enough to
  /// call the map so, since what is in force is valid on the present one.
  GateEvents Begin(const MapPtr& map, std::int64_t map_id) const {
    GateEvents events;
    if (map) {
      for (const std::int64_t id : replaced_.maps) {
        if (id != deployed_.map_id) events.emplace_back(MapEvent{map, id});
      }
      events.emplace_back(MapEvent{map, map_id});
    }
    // Those of before under a request of before: under the present one, one
    // that cannot be read would be in force.
    const std::int64_t before = deployed_.request_id == 1 ? 2 : 1;
    events.emplace_back(RequestEvent{before, false, {}, {}});
    for (const std::int64_t digest : replaced_.baselines) {
      if (digest == deployed_.baseline_digest) continue;
      events.emplace_back(BaselineOf(map_id, digest, {}));
      std::get<BaselineEvent>(events.back()).request_id = before;
    }
    for (const std::int64_t id : replaced_.requests) {
      events.emplace_back(RequestEvent{id, false, {}, {}});
    }
    events.emplace_back(RequestEvent{deployed_.request_id,
                                     false,
                                     {deployed_.start_x, deployed_.start_y},
                                     {deployed_.goal_x, deployed_.goal_y}});
    return events;
  }

  BaselineEvent BaselineOf(std::int64_t map_id, std::int64_t digest,
                           Route waypoints) const {
    BaselineEvent event;
    event.request_id = deployed_.request_id;
    event.map_id = map_id;
    event.has_route = true;
    event.baseline_digest = digest;
    event.waypoints = std::move(waypoints);
    return event;
  }

  /// The advice that makes a gate deploy what was deployed.
  AdviceEvent Advice(std::int64_t map_id, std::int64_t digest) const {
    AdviceEvent event;
    event.session = deployed_.source_session;
    event.advisor = deployed_.source;
    event.attempt = deployed_.source_attempt;
    event.candidate = deployed_.source_candidate;
    event.request_id = deployed_.request_id;
    event.map_id = map_id;
    event.baseline_digest = digest;
    event.anchor.cell = Cell{deployed_.start_x, deployed_.start_y};
    event.kind = verifier::AdviceKind::kPropose;
    event.waypoints = bus::WaypointsOf(deployed_);
    return event;
  }

 private:
  const deployed_t& deployed_;
  const LaterDecisions::Replaced& replaced_;
};

bool TellsTheSame(verifier::Deployed state, const deployed_t& deployed) {
  state.decision = deployed.decision;
  state.route_seq = deployed.route_seq;
  state.cause = verifier::Cause{deployed.cause};
  return Essence(verifier::ToMessage(state)) == Essence(deployed);
}

Error Differs(const deployed_t& deployed, const verifier::Deployed& state) {
  return Error{ErrorCode::kInvalid, "the log says " + InWords(deployed) +
                                        ", but from its inputs follows " +
                                        InWords(verifier::ToMessage(state))};
}

// No route: nothing asked, cancelled, or none found.
ReplayedGate WithoutRoute(const deployed_t& deployed, const StateEvents& state,
                          const MapPtr& map, ReplayedGate gate) {
  gate.Hear(state.Begin(map, deployed.map_id));
  if (deployed.cause == deployed_t::CAUSE_CANCELLED) {
    gate.Hear({RequestEvent{deployed.request_id, true, {}, {}}});
  } else if (deployed.cause == deployed_t::CAUSE_NO_ROUTE) {
    BaselineEvent none = state.BaselineOf(deployed.map_id, 0, {});
    none.has_route = false;
    gate.Hear({none});
  }
  return gate;
}

// A candidate that a map update left in force, though the baseline held does
// not stand, or only just, or there is none: it is deployed against a baseline
// made up for it.
bool IsKeptCandidate(const deployed_t& deployed, const StateEvents& state,
                     const MapPtr& map, const BaselineEvent* baseline,
                     double margin, ReplayedGate& gate) {
  if (deployed.mode != deployed_t::MODE_CANDIDATE) return false;
  const Cell start = {deployed.start_x, deployed.start_y};
  const Cell goal = {deployed.goal_x, deployed.goal_y};
  const Route route = bus::WaypointsOf(deployed);
  if (!verifier::CheckRoute(*map, route, start, goal, verifier::kBusLimits)
           .feasible()) {
    return false;
  }
  const Route dearer = Dearer(*map, route, margin + 1);
  const std::int64_t digest =
      BaselineDigest(deployed.request_id, deployed.map_id, dearer);
  gate.Hear(state.Begin(map, deployed.map_id));
  gate.Hear({state.BaselineOf(deployed.map_id, digest, dearer),
             state.Advice(deployed.map_id, digest)});
  verifier::Deployed kept = gate.deployed();
  kept.baseline_digest = deployed.baseline_digest;
  kept.baseline_cost = kImpassable;
  if (baseline != nullptr) {
    kept.baseline_cost = verifier::CheckRoute(*map, baseline->waypoints, start,
                                              goal, verifier::kBusLimits)
                             .cost;
  } else {
    BaselineEvent none = state.BaselineOf(deployed.map_id, 0, {});
    none.has_route = false;
    gate.Hear({none});
  }
  return TellsTheSame(kept, deployed);
}

}  // namespace

Result<ReplayedGate> GateInState(const deployed_t& deployed,
                                 LogContents& contents,
                                 const verifier::GateOptions& options,
                                 const LaterDecisions::Replaced& replaced) {
  const StateEvents state(deployed, replaced);
  const ReplayedGate fresh(options);
  const MapPtr map = Terrain(contents.maps.Find(deployed.map_id));
  if (!map && deployed.map_id != 0) {
    return Error{ErrorCode::kNotFound, "the log does not hold all of map " +
                                           std::to_string(deployed.map_id)};
  }
  ReplayedGate kept = fresh;
  if (deployed.baseline_digest == 0 || !map) {
    if (map &&
        IsKeptCandidate(deployed, state, map, nullptr, options.margin, kept)) {
      return kept;
    }
    ReplayedGate gate = WithoutRoute(deployed, state, map, fresh);
    if (TellsTheSame(gate.deployed(), deployed)) return gate;
    return Differs(deployed, gate.deployed());
  }
  const auto* found = contents.FindBaseline(
      deployed.baseline_digest,
      deployed.mode == deployed_t::MODE_BASELINE ? deployed.source_session : 0);
  if (found == nullptr) {
    return Error{ErrorCode::kNotFound,
                 "the log does not hold baseline " +
                     std::to_string(deployed.baseline_digest)};
  }
  const BaselineEvent baseline = verifier::ToEvent(found->message);
  ReplayedGate gate = fresh;
  gate.Hear(state.Begin(map, baseline.map_id));
  gate.Hear({baseline});
  if (deployed.mode == deployed_t::MODE_CANDIDATE) {
    gate.Hear({state.Advice(baseline.map_id, deployed.baseline_digest)});
  }
  gate.Hear({MapEvent{map, deployed.map_id}});
  if (TellsTheSame(gate.deployed(), deployed)) return gate;
  if (IsKeptCandidate(deployed, state, map, &baseline, options.margin, kept)) {
    return kept;
  }
  return Differs(deployed, gate.deployed());
}

}  // namespace terra::logger

#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "terrain/digest.h"
#include "verifier/gate.h"

namespace terra::verifier {

/// Speaks to a gate the way the bus does, with as few words as a test needs.
/// The request is from (0, 1) to (5, 1) unless a test says otherwise.
class GateHarness {
 public:
  static constexpr std::int64_t kSession = 4711;

  explicit GateHarness(double margin = 0)
      : gate(GateOptions{.margin = margin, .session = kSession}) {}

  Decisions Map(TerrainMap map) {
    auto shared = std::make_shared<const TerrainMap>(std::move(map));
    map_id = MapId(*shared);
    return gate.On(MapEvent{shared, map_id});
  }

  Decisions Request(std::int64_t id) {
    request_id = id;
    return gate.On(RequestEvent{id, false, start, goal});
  }
  Decisions Cancel(std::int64_t id) {
    return gate.On(RequestEvent{id, true, start, goal});
  }

  /// What a planner says about the request and map of the harness.
  BaselineEvent BaselineOf(Route route) const {
    BaselineEvent event;
    event.session = 500;
    event.planner = "planner";
    event.request_id = request_id;
    event.start = start;
    event.goal = goal;
    event.map_id = map_id;
    event.has_route = true;
    event.baseline_digest = BaselineDigest(request_id, map_id, route);
    event.waypoints = std::move(route);
    return event;
  }
  Decisions Baseline(Route route) {
    const BaselineEvent event = BaselineOf(std::move(route));
    baseline_digest = event.baseline_digest;
    return gate.On(event);
  }
  Decisions NoRoute() {
    BaselineEvent event = BaselineOf({});
    event.has_route = false;
    event.baseline_digest = 0;
    return gate.On(event);
  }

  /// A new proposal for the baseline last said.
  AdviceEvent AdviceOf(Route route) {
    AdviceEvent event;
    event.session = 900;
    event.advisor = "search";
    event.attempt = ++attempt;
    event.candidate = 1;
    event.request_id = request_id;
    event.map_id = map_id;
    event.baseline_digest = baseline_digest;
    event.anchor.cell = start;
    event.kind = AdviceKind::kPropose;
    event.waypoints = std::move(route);
    return event;
  }
  Decisions Advise(Route route) { return gate.On(AdviceOf(std::move(route))); }

  /// A new proposal from a cell of the deployed route on.
  AdviceEvent AdviceFrom(int index, Cell cell, Route route) {
    AdviceEvent event = AdviceOf(std::move(route));
    event.anchor = Anchor{kSession, deployed().route_seq, index, cell};
    return event;
  }
  /// The robot, on the deployed route.
  Decisions Pose(Cell cell) {
    return gate.On(PoseEvent{cell, kSession, deployed().route_seq});
  }

  const Deployed& deployed() const { return gate.deployed(); }

  Gate gate;
  Cell start{0, 1};
  Cell goal{5, 1};
  std::int64_t map_id = 0;
  std::int64_t request_id = 0;
  std::int64_t baseline_digest = 0;
  std::int64_t attempt = 0;
};

inline std::vector<Verdict> VerdictsOf(const Decisions& decisions) {
  std::vector<Verdict> verdicts;
  for (const Decision& decision : decisions) {
    if (const auto* verdict = std::get_if<Verdict>(&decision)) {
      verdicts.push_back(*verdict);
    }
  }
  return verdicts;
}

inline std::vector<Deployed> DeploymentsOf(const Decisions& decisions) {
  std::vector<Deployed> deployments;
  for (const Decision& decision : decisions) {
    if (const auto* deployed = std::get_if<Deployed>(&decision)) {
      deployments.push_back(*deployed);
    }
  }
  return deployments;
}

/// The code of the one verdict that must be there.
inline Code CodeOf(const Decisions& decisions) {
  const std::vector<Verdict> verdicts = VerdictsOf(decisions);
  return verdicts.size() == 1 ? verdicts.front().code : Code::kNotChecked;
}

}  // namespace terra::verifier

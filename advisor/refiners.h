#pragma once

#include <stop_token>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// What a deterministic refiner works on: a valid baseline on the fine map.
struct RefineInput {
  const TerrainMap& map;
  const Route& baseline;     ///< Feasible; its ends are start and goal.
  double baseline_cost = 0;  ///< Equals WalkRoute(map, baseline).cost.
  /// Asks for an early end: the best route so far is returned.
  std::stop_token stop = {};
};

/// What it proposes: the baseline itself when it found nothing cheaper (except
/// the methods that say otherwise).
struct RefineOutput {
  Route route;
  double cost = kImpassable;  ///< Equals WalkRoute(map, route).cost.
};

/// All refiners: deterministic, without random numbers; same input, same route.
/// They know nothing of each other and of the gate, which checks what they say.
/// Threads: reentrant.

/// The native optimum, thinned to few waypoints: upper bound of all refiners.
RefineOutput RefineBySearch(const RefineInput& input);

/// Cost-gated all-pairs shortcut over dense cells, then vertex perturbation,
/// repeated until nothing falls. Reference: PathSimplifier-style shortcutting
/// (Geraerts and Overmars 2007), made cost-aware.
RefineOutput RefineByShortcut(const RefineInput& input);

/// The route with its cost, or the baseline where the route is not cheaper.
RefineOutput OrBaseline(const RefineInput& input, Route route);

}  // namespace terra::advisor

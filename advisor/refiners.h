#pragma once

#include <stop_token>

#include "advisor/corridor.h"
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

/// Optimum inside the corridor of Chebyshev `half_width` around the baseline.
RefineOutput RefineByBand(const RefineInput& input,
                          int half_width = kCorridorHalfWidth);

enum class CampanaForm {
  kLastIterate,      ///< Length objective, exactly as it ends: may be dearer.
  kKeepBest,         ///< Length objective, the cheapest valid iterate.
  kTerrainWeighted,  ///< Segments weighted by their terrain cost, keep-best.
};

/// Gradient-based shortening of the baseline's waypoints, which adds none and
/// slides them along obstacles by linear constraints; see campana.cc.
/// Source: Campana, Lamiraux, Laumond 2016, A gradient-based path optimization
///         method for motion planning (Advanced Robotics 30), as their public
///         implementation has it, for a point robot in the plane.
RefineOutput RefineByCampana(const RefineInput& input, CampanaForm form);

/// APP-style: vertex reduction from both ends, each segment cost-gated, and
/// iterative perturbation, repeated until nothing falls.
/// Source: after the abstract of Li, Cheng 2023 (IEEE RA-L 8(11)), which leaves
///         the thresholds open; not the authors' implementation.
RefineOutput RefineByAppStyle(const RefineInput& input);

}  // namespace terra::advisor

#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// What a deterministic refiner works on: a valid baseline on the fine map.
struct RefineInput {
  const TerrainMap& map;
  const Route& baseline;     ///< Feasible; its ends are start and goal.
  double baseline_cost = 0;  ///< Equals WalkRoute(map, baseline).cost.
};

/// What it proposes: the baseline itself when it found nothing cheaper (except
/// the methods that say otherwise).
struct RefineOutput {
  Route route;
  double cost = kImpassable;  ///< Equals WalkRoute(map, route).cost.
};

/// The native optimum, thinned to few waypoints: upper bound of all refiners.
RefineOutput RefineBySearch(const RefineInput& input);

/// Cost-gated all-pairs shortcut over dense cells, then vertex perturbation,
/// repeated until nothing falls. Reference: PathSimplifier-style shortcutting
/// (Geraerts and Overmars 2007), made cost-aware.
RefineOutput RefineByShortcut(const RefineInput& input);

/// Optimum inside the corridor of Chebyshev `half_width` around the baseline.
RefineOutput RefineByBand(const RefineInput& input, int half_width = 25);

/// Gradient-based shortening (Campana, Lamiraux, Laumond 2016), point robot.
enum class CampanaForm {
  kLastIterate,      ///< Length objective, exactly as it ends: may be dearer.
  kKeepBest,         ///< Length objective, the cheapest valid iterate.
  kTerrainWeighted,  ///< Segments weighted by their terrain cost, keep-best.
};
RefineOutput RefineByCampana(const RefineInput& input, CampanaForm form);

/// APP-style (Li and Cheng 2023, after its abstract): bidirectional vertex
/// reduction and iterative perturbation.
RefineOutput RefineByAppStyle(const RefineInput& input);

/// Plain line-of-sight shortcutting without a cost test: the control that shows
/// why cost gating matters; may be dearer than the baseline.
RefineOutput ShortcutWithoutCost(const RefineInput& input);

}  // namespace terra::advisor

#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra {

/// Why a route cannot be driven.
enum class RouteFault {
  kNone,
  kOutOfBounds,  ///< A waypoint or segment cell lies outside the map.
  kObstacle,     ///< A cell is blocked, or a diagonal step cuts a corner and
                 ///< the cost model forbids it (the cell entered is named).
  kWorkLimit,    ///< More steps than allowed; nothing is said of the rest.
};

/// What a walk along a route found.
struct RouteWalk {
  RouteFault fault = RouteFault::kNone;
  /// Where it failed, in travel order: segment from 0, and the cell.
  int segment = -1;
  Cell cell;
  /// Steps taken, the failing one not counted.
  std::int64_t steps = 0;
  /// Sum over the steps; kImpassable when fault is not kNone.
  double cost = kImpassable;

  bool feasible() const { return fault == RouteFault::kNone; }
};

inline constexpr std::int64_t kNoStepLimit =
    std::numeric_limits<std::int64_t>::max();

/// Walks a route and sums its cost: the one cost rule of the project.
///
/// Cost is the sum over successive cells of step length (1 or sqrt 2) times the
/// cost of the cell entered; the first cell is free, cells that repeat in
/// succession count once. With a legend of exact units (CostTable) the sums are
/// integers, so the result does not depend on how a route is cut into segments.
///
/// Pre:    at least one waypoint. Any coordinates; the walk ends at the first
///         failing cell, so it takes at most the map's longest side of steps
///         beyond the last good waypoint.
/// Source: paper, Problem Formulation, Eq. terrain-cost.
RouteWalk WalkRoute(const TerrainMap& map, std::span<const Cell> route,
                    std::int64_t max_steps = kNoStepLimit);

/// Returns the cost of one segment, kImpassable when it is not feasible.
double SegmentCost(const TerrainMap& map, Cell from, Cell to);

}  // namespace terra

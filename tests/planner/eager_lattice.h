#pragma once

#include <compare>
#include <cstdint>

#include "planner/coarse_lattice.h"
#include "terrain/map.h"

namespace terra::testing {

/// A cost of straight + diagonal sqrt 2 thousandths, compared exactly.
struct ExactCost {
  std::int64_t straight = 0;
  std::int64_t diagonal = 0;

  double value() const;
  friend ExactCost operator+(ExactCost a, ExactCost b) {
    return {a.straight + b.straight, a.diagonal + b.diagonal};
  }
  friend bool operator==(ExactCost, ExactCost) = default;
  friend std::strong_ordering operator<=>(ExactCost a, ExactCost b);
};

struct EagerPlan {
  bool found = false;
  Route waypoints;
  ExactCost cost;
};

/// The lattice of docs/decisions.md written down a second time, slow and
/// obvious: lists every node and edge, costs every edge cell by cell from the
/// ids and the legend, and searches with labels (cost, raster steps, the whole
/// node sequence). Shares no search, segment, clearance or cost code with the
/// project.
///
/// Pre: both ends passable; all finite costs multiples of 1/1000.
EagerPlan PlanEagerly(const TerrainMap& map, Cell start, Cell goal,
                      const planner::LatticeOptions& options);

}  // namespace terra::testing

#pragma once

#include <cstdint>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// An 8-connected set of cells of one cost.
struct TerrainRegion {
  double cost = kImpassable;
  std::int64_t cells = 0;
  Cell low;     ///< Least x and least y of its cells.
  Cell high;    ///< Greatest x and y.
  Cell inside;  ///< One of its cells: the middle of its longest row.
};

/// The regions of a map that are worth words.
struct TerrainRegions {
  std::vector<TerrainRegion> large;  ///< Largest first; ties in map order.
  std::int64_t small_regions = 0;    ///< The others: how many, ...
  std::int64_t small_cells = 0;      ///< ... and their cells together.
};

/// Finds the regions of more than `above_cells` cells, at most `at_most`.
/// A cell blocked by the clearance rule counts as obstacle.
/// Source: union of row runs, after Rosenfeld and Pfaltz 1966 (Journal of the
///         ACM 13:4); the limits are those of docs/advisor.md.
TerrainRegions FindRegions(const TerrainMap& map,
                           std::int64_t above_cells = 200,
                           std::size_t at_most = 40);

}  // namespace terra::advisor

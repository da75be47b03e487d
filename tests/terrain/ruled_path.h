#pragma once

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::testing {

/// The path that the tie rule (SearchResult::cells) names, found slowly and
/// obviously: a plain Dijkstra over the whole map, without bounds, buckets or
/// pruning, whose sums are pairs of integers compared exactly.
/// Empty where there is no path.
CellPath RuledPath(const TerrainMap& map, Cell start, Cell goal);

}  // namespace terra::testing

#pragma once

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::benchmark {

/// LLM-A* in its original form: one A* whose estimate adds the distance to the
/// current target, f = g + h(cell, goal) + |cell - target|, both Euclidean and
/// in units of the lowest cost. When a generated cell is the target, the next
/// one takes its place and all open cells are valued anew. Targets outside the
/// map or blocked are dropped, as the authors' program does.
///
/// An unreachable target does no harm but keeps pulling; the route is feasible,
/// not optimal. Without targets it is the "no advice" control, whose f is
/// g + 2 h.
/// Returns the cells' corners; empty where there is no path.
/// Source: Meng et al. 2024 (arXiv 2407.02511), Algorithm 1.
Route SingleTargetedSearch(const TerrainMap& map, Cell start, Cell goal,
                           const Route& targets);

}  // namespace terra::benchmark

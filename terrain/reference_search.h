#pragma once

#include "terrain/map.h"
#include "terrain/search_result.h"

namespace terra {

/// Finds a cheapest 8-connected path with a plain Dijkstra in double precision.
///
/// Slow and obvious on purpose: the oracle that every faster search is tested
/// against. Same cost rule and cost model as WalkRoute.
/// Source: Dijkstra 1959 (Numerische Mathematik 1).
SearchResult ReferenceSearch(const TerrainMap& map, Cell start, Cell goal);

}  // namespace terra

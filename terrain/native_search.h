#pragma once

#include "terrain/map.h"
#include "terrain/search_result.h"

namespace terra {

/// What a native search may be told.
struct NativeSearchOptions {
  /// Cost of a known route between the ends (the baseline's): paths that cannot
  /// be cheaper need not be looked at. A route of exactly this cost is found.
  double upper_bound = kImpassable;
};

/// Finds a cheapest 8-connected path on all cells, exactly.
///
/// Under the paper's cost model (corner cutting on) its cost is a lower bound
/// of every feasible route. Threads: reentrant.
SearchResult NativeSearch(const TerrainMap& map, Cell start, Cell goal,
                          const NativeSearchOptions& options = {});

}  // namespace terra

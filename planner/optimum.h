#pragma once

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/native_search.h"
#include "terrain/search_result.h"

namespace terra::planner {

/// Finds the native optimum where no route is known: takes the lattice's cost
/// as the search's upper bound. The lattice costs a few hundredths of the
/// search and saves it a quarter to half of its time; where the lattice finds
/// no route the search does without.
///
/// Replaces options.upper_bound if the lattice's cost is below it.
/// Threads: reentrant.
SearchResult FindOptimum(const TerrainMap& map, Cell start, Cell goal,
                         NativeSearchOptions options = {});

}  // namespace terra::planner

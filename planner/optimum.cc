#include "planner/optimum.h"

#include <algorithm>

#include "planner/coarse_lattice.h"

namespace terra::planner {

SearchResult FindOptimum(const TerrainMap& map, Cell start, Cell goal,
                         NativeSearchOptions options) {
  options.upper_bound =
      std::min(options.upper_bound, PlanOnLattice(map, start, goal).cost);
  return NativeSearch(map, start, goal, options);
}

}  // namespace terra::planner

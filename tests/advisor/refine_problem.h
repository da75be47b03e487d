#pragma once

#include <algorithm>
#include <utility>

#include "advisor/refiners.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/random_map.h"

namespace terra::testing {

/// A map and a baseline that can be driven on it.
struct RefineProblem {
  TerrainMap map;
  Route baseline;
  double baseline_cost = 0;

  advisor::RefineInput input() const { return {map, baseline, baseline_cost}; }
};

/// A random map, and a baseline through some random cells of it by the optimum
/// from each to the next: feasible, and with room to improve.
inline RefineProblem RandomRefineProblem(Random& random, int max_side) {
  for (;;) {
    const CostModel model{.corner_cutting = !random.OneIn(3),
                          .clearance_cells = random.OneIn(5) ? 1 : 0};
    TerrainMap map =
        RandomMap(random, random.Int(2, max_side), random.Int(2, max_side),
                  static_cast<RandomMapKind>(random.Int(0, 2)), model);
    if ((map.classes() == 0).all()) continue;
    Route baseline = {RandomPassableCell(random, map)};
    for (int legs = random.Int(1, 3); legs > 0; --legs) {
      const Cell to = RandomPassableCell(random, map);
      const SearchResult leg = NativeSearch(map, baseline.back(), to);
      if (!leg.found()) continue;
      const Route corners = CornersOf(leg.cells);
      baseline.insert(baseline.end(), corners.begin() + 1, corners.end());
    }
    if (baseline.size() < 2) continue;
    const double cost = WalkRoute(map, baseline).cost;
    return {std::move(map), std::move(baseline), cost};
  }
}

}  // namespace terra::testing

#include "tests/terrain/search_agreement.h"

#include <cmath>

#include "terrain/reference_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"

namespace terra::testing {

std::vector<SearchWay> AllSearchWays() {
  std::vector<SearchWay> ways;
  ways.push_back({"automatic", {}});
  ways.push_back({"buckets, narrow", {.method = SearchMethod::kBuckets}});
  ways.push_back({"buckets, wide",
                  {.method = SearchMethod::kBuckets, .keys = KeyWidth::kWide}});
  ways.push_back(
      {"buckets, doubles",
       {.method = SearchMethod::kBuckets, .keys = KeyWidth::kDouble}});
  for (const auto set : {InstructionSet::kPortable, InstructionSet::kAvx2,
                         InstructionSet::kAvx512}) {
    if (set <= BestInstructionSet()) {
      ways.push_back({"sweep " + std::to_string(static_cast<int>(set)),
                      {.method = SearchMethod::kSweep, .instructions = set}});
    }
  }
  return ways;
}

::testing::AssertionResult AllWaysAgree(const TerrainMap& map, Cell start,
                                        Cell goal) {
  const SearchResult want = ReferenceSearch(map, start, goal);
  for (SearchWay way : AllSearchWays()) {
    for (const bool bounded : {false, true}) {
      way.options.upper_bound = bounded ? want.cost : kImpassable;
      const SearchResult got = NativeSearch(map, start, goal, way.options);
      const auto fail = [&](const std::string& what) {
        return ::testing::AssertionFailure()
               << way.name << (bounded ? ", bounded: " : ": ") << what << ", "
               << ToString(start) << " to " << ToString(goal) << ", cost "
               << got.cost << ", reference " << want.cost;
      };
      if (got.status != want.status) return fail("another status");
      if (!want.found()) continue;
      // Exact units leave no room for another cost.
      const double tolerance = map.costs().scale != 0 ? 0 : 1e-12 * want.cost;
      if (std::abs(got.cost - want.cost) > tolerance) return fail("other cost");
      if (got.cells.front() != start || got.cells.back() != goal) {
        return fail("other ends");
      }
      for (std::size_t i = 1; i < got.cells.size(); ++i) {
        if (ChebyshevDistance(got.cells[i - 1], got.cells[i]) != 1) {
          return fail("not a path");
        }
      }
      const RouteWalk walk = WalkRoute(map, got.cells);
      if (!walk.feasible() || walk.cost != got.cost) {
        return fail("not what the cost rule says");
      }
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace terra::testing

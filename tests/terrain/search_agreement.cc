#include "tests/terrain/search_agreement.h"

#include <cmath>
#include <utility>

#include "terrain/reference_search.h"
#include "terrain/route_cost.h"
#include "terrain/search_keys.h"
#include "tests/terrain/ruled_path.h"

namespace terra::testing {

namespace {

// Whether narrow keys hold every path there is, so that a forced sweep has no
// reason to leave the work to A*.
bool NarrowKeysHoldAllPaths(const TerrainMap& map) {
  return map.cost_grid().holds_units() && map.costs().num_classes > 0 &&
         static_cast<double>(map.ids().size()) *
                 NarrowKeys(map).max_diagonal() <
             NarrowKeys::kLimit;
}

// What is wrong with an answer; empty if nothing.
std::string Fault(const TerrainMap& map, const SearchWay& way,
                  const SearchResult& got, const SearchResult& want,
                  const CellPath& ruled) {
  if (got.status != want.status) return "another status";
  const bool swept = got.passes > 0;
  if (way.options.method == SearchMethod::kBuckets && swept) {
    return "a sweep where A* was asked for";
  }
  if (!want.found()) return "";
  const bool one_cell = want.cells.size() == 1;
  if (way.options.method == SearchMethod::kSweep && !swept && !one_cell &&
      NarrowKeysHoldAllPaths(map)) {
    return "no sweep where one was asked for";
  }
  // Exact units leave no room for another cost.
  const double tolerance = map.costs().scale != 0 ? 0 : 1e-12 * want.cost;
  if (std::abs(got.cost - want.cost) > tolerance) return "other cost";
  if (got.cells != ruled) return "another path than the tie rule names";
  const RouteWalk walk = WalkRoute(map, got.cells);
  const bool as_ruled = walk.feasible() && walk.cost == got.cost;
  return as_ruled ? "" : "not what the cost rule says";
}

}  // namespace

std::vector<SearchWay> AllSearchWays() {
  std::vector<SearchWay> ways = {
      {"buckets, integers", {.method = SearchMethod::kBuckets}},
      {"buckets, rounded",
       {.method = SearchMethod::kBuckets, .keys = KeyWidth::kRounded}}};
  for (const auto& [set, name] :
       {std::pair{InstructionSet::kPortable, "portable"},
        std::pair{InstructionSet::kAvx2, "AVX2"},
        std::pair{InstructionSet::kAvx512, "AVX-512"}}) {
    if (set <= BestInstructionSet()) {
      ways.push_back(
          {std::string("automatic, ") + name,
           {.method = SearchMethod::kAutomatic, .instructions = set}});
      ways.push_back({std::string("sweep, ") + name,
                      {.method = SearchMethod::kSweep, .instructions = set}});
    }
  }
  return ways;
}

::testing::AssertionResult AllWaysAgree(const TerrainMap& map, Cell start,
                                        Cell goal) {
  const SearchResult want = ReferenceSearch(map, start, goal);
  const CellPath ruled =
      want.found() ? RuledPath(map, start, goal) : CellPath();
  for (SearchWay way : AllSearchWays()) {
    // As without a baseline, with the best one, and with a usual one.
    for (const double bound : {kImpassable, want.cost, 1.2 * want.cost}) {
      way.options.upper_bound = bound;
      const SearchResult got = NativeSearch(map, start, goal, way.options);
      const std::string fault = Fault(map, way, got, want, ruled);
      if (!fault.empty()) {
        return ::testing::AssertionFailure()
               << way.name << ", upper bound " << bound << ": " << fault << ", "
               << ToString(start) << " to " << ToString(goal) << ", cost "
               << got.cost << ", reference " << want.cost;
      }
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace terra::testing

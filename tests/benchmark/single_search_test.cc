#include "benchmark/single_search.h"

#include <gtest/gtest.h>

#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra::benchmark {
namespace {

using terra::testing::MapFromAscii;
using terra::testing::Random;
using terra::testing::RandomMap;
using terra::testing::RandomMapKind;
using terra::testing::RandomPassableCell;

// The row in which a route crosses a column.
int RowAtColumn(const Route& route, int x) {
  for (const Cell cell : RasterizeRoute(route)) {
    if (cell.x == x) return cell.y;
  }
  return -1;
}

TEST(SingleTargetedSearch, FindsAFeasibleRouteWheneverThereIsOne) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const TerrainMap map = RandomMap(random, 30, 25, RandomMapKind::kObstacles);
    const Cell start = RandomPassableCell(random, map);
    const Cell goal = RandomPassableCell(random, map);
    const Route targets = {{random.Int(-5, 35), random.Int(-5, 30)},
                           {random.Int(0, 29), random.Int(0, 24)}};
    const Route route = SingleTargetedSearch(map, start, goal, targets);
    const SearchResult best = NativeSearch(map, start, goal);
    ASSERT_EQ(route.empty(), !best.found()) << i;
    if (route.empty()) continue;
    const RouteWalk walk = WalkRoute(map, route);
    EXPECT_TRUE(walk.feasible());
    EXPECT_EQ(route.front(), start);
    EXPECT_EQ(route.back(), goal);
    EXPECT_GE(walk.cost, best.cost - 1e-9);
  }
}

TEST(SingleTargetedSearch, ATargetPullsTheRoute) {
  // Two ways round a wall of the same length; the target decides.
  const TerrainMap map = MapFromAscii({"1111111",  //
                                       "1111111",  //
                                       "111#111",  //
                                       "1111111",  //
                                       "1111111"});
  EXPECT_LT(RowAtColumn(SingleTargetedSearch(map, {0, 2}, {6, 2}, {{3, 0}}), 3),
            2);
  EXPECT_GT(RowAtColumn(SingleTargetedSearch(map, {0, 2}, {6, 2}, {{3, 4}}), 3),
            2);
}

}  // namespace
}  // namespace terra::benchmark

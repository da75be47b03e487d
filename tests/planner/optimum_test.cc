#include "planner/optimum.h"

#include <gtest/gtest.h>

#include "planner/coarse_lattice.h"
#include "terrain/builtin_legends.h"
#include "tests/support/random_map.h"

namespace terra::planner {
namespace {

using testing::Random;
using testing::RandomMapKind;

// Some of the maps have no lattice route.
TEST(OptimumTest, FindsWhatTheNativeSearchFindsWithoutABound) {
  Random random(7);
  int only_without_lattice = 0;
  for (int i = 0; i < 300; ++i) {
    const auto kind = static_cast<RandomMapKind>(random.Int(0, 2));
    const TerrainMap map =
        RandomMap(random, random.Int(20, 160), random.Int(20, 160), kind);
    const Cell start = RandomPassableCell(random, map);
    const Cell goal = RandomPassableCell(random, map);
    const SearchResult want = NativeSearch(map, start, goal);
    const SearchResult got = FindOptimum(map, start, goal);
    EXPECT_EQ(got.status, want.status) << "map " << i;
    EXPECT_EQ(got.cost, want.cost) << "map " << i;
    only_without_lattice +=
        want.found() && !PlanOnLattice(map, start, goal).found() ? 1 : 0;
  }
  EXPECT_GT(only_without_lattice, 0);
}

TEST(OptimumTest, SaysWhereThereIsNoRoute) {
  constexpr std::uint8_t kWall = 11;
  ByteRaster ids = ByteRaster::Zero(60, 120);
  ids.col(70) = kWall;
  const TerrainMap map =
      TerrainMap::Create(ids, MultiTerraPathLegend()).value();
  EXPECT_EQ(FindOptimum(map, {5, 5}, {110, 50}).status, SearchStatus::kNoRoute);
  EXPECT_EQ(FindOptimum(map, {5, 5}, {70, 50}).status,
            SearchStatus::kGoalBlocked);
}

TEST(OptimumTest, AKnownRouteThatIsDearerThanTheLatticesDoesNoHarm) {
  Random random(8);
  const TerrainMap map =
      RandomMap(random, 120, 120, RandomMapKind::kRectangles);
  const Cell start = RandomPassableCell(random, map);
  const Cell goal = RandomPassableCell(random, map);
  const double want = NativeSearch(map, start, goal).cost;
  EXPECT_EQ(FindOptimum(map, start, goal, {.upper_bound = 2 * want}).cost,
            want);
  EXPECT_EQ(FindOptimum(map, start, goal, {.upper_bound = want}).cost, want);
}

}  // namespace
}  // namespace terra::planner

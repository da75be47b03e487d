#include "advisor/terrain_regions.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_map.h"

namespace terra::advisor {
namespace {

using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;

// The oracle: a flood fill from each cell not yet seen.
std::multiset<std::int64_t> RegionSizes(const TerrainMap& map) {
  std::multiset<std::int64_t> sizes;
  ByteRaster seen = ByteRaster::Zero(map.height(), map.width());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (seen(y, x) != 0) continue;
      std::int64_t size = 0;
      std::vector<Cell> open = {{x, y}};
      seen(y, x) = 1;
      while (!open.empty()) {
        const Cell at = open.back();
        open.pop_back();
        ++size;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const Cell to{at.x + dx, at.y + dy};
            if (!map.Contains(to) || seen(to.y, to.x) != 0 ||
                map.Cost(to) != map.Cost(at)) {
              continue;
            }
            seen(to.y, to.x) = 1;
            open.push_back(to);
          }
        }
      }
      sizes.insert(size);
    }
  }
  return sizes;
}

TEST(Regions, AreThoseOfAFloodFill) {
  Random random(9);
  for (int round = 0; round < 60; ++round) {
    const auto kind =
        round % 2 == 0 ? RandomMapKind::kNoise : RandomMapKind::kRectangles;
    const TerrainMap map =
        RandomMap(random, random.Int(1, 40), random.Int(1, 40), kind);
    const TerrainRegions found = FindRegions(map, 0, 1'000'000);
    std::multiset<std::int64_t> sizes;
    for (const TerrainRegion& region : found.large) {
      sizes.insert(region.cells);
      EXPECT_EQ(map.Cost(region.inside), region.cost);
      EXPECT_TRUE(
          region.inside.x >= region.low.x && region.inside.x <= region.high.x &&
          region.inside.y >= region.low.y && region.inside.y <= region.high.y);
    }
    EXPECT_EQ(sizes, RegionSizes(map));
  }
}

TEST(Regions, SmallOnesAndThoseBeyondTheLimitAreSummedUp) {
  Random random(10);
  const TerrainMap map = RandomMap(random, 60, 60, RandomMapKind::kRectangles);
  const TerrainRegions all = FindRegions(map, 0, 1'000'000);
  const TerrainRegions few = FindRegions(map, 20, 3);
  ASSERT_EQ(few.large.size(), 3u);
  std::int64_t cells = few.small_cells;
  for (const TerrainRegion& region : few.large) {
    EXPECT_GT(region.cells, 20);
    cells += region.cells;
  }
  EXPECT_EQ(cells, 60 * 60);
  EXPECT_EQ(few.small_regions + 3, static_cast<int>(all.large.size()));
}

}  // namespace
}  // namespace terra::advisor

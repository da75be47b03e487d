#include "terrain/native_search.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/reference_search.h"
#include "tests/support/random_map.h"
#include "tests/terrain/search_agreement.h"

namespace terra {
namespace {

using testing::AllSearchWays;
using testing::AllWaysAgree;
using testing::Random;
using testing::RandomMapKind;
using testing::SearchWay;

CostModel RandomCostModel(Random& random) {
  return CostModel{.corner_cutting = !random.OneIn(3),
                   .clearance_cells = random.OneIn(5) ? random.Int(1, 3) : 0};
}

// The map's ids under another legend: random costs for the ids 0 to 10, of one
// to max_parts parts.
TerrainMap WithRandomCosts(Random& random, const TerrainMap& map, int max_parts,
                           double smallest_part) {
  std::vector<Terrain> terrains = map.legend().terrains();
  for (Terrain& terrain : terrains) {
    if (terrain.cost != kImpassable) {
      terrain.cost = random.Int(1, max_parts) * smallest_part;
    }
  }
  return TerrainMap::Create(map.ids(),
                            Legend::Create(std::move(terrains)).value(),
                            map.cost_model())
      .value();
}

bool HasPassableCell(const TerrainMap& map) {
  return (map.classes() != 0).any();
}

struct MapSizes {
  int max_width;
  int max_height;
};

void ExpectAgreementOnRandomMaps(std::uint64_t seed, int count, MapSizes sizes,
                                 double smallest_part = 0,
                                 int max_parts = 400) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<RandomMapKind>(random.Int(0, 2));
    TerrainMap map = RandomMap(random, random.Int(1, sizes.max_width),
                               random.Int(1, sizes.max_height), kind,
                               RandomCostModel(random));
    if (smallest_part != 0) {
      map = WithRandomCosts(random, map, max_parts, smallest_part);
    }
    if (HasPassableCell(map)) {
      ASSERT_TRUE(AllWaysAgree(map, RandomPassableCell(random, map),
                               RandomPassableCell(random, map)))
          << "map " << i << " of seed " << seed;
    }
  }
}

// AllWaysAgree forces them one by one. (A few of the maps have no passable
// cell, or start and goal in one place.)
TEST(NativeSearchTest, EachWayFindsTheReferenceCostOn12000SmallMaps) {
  ExpectAgreementOnRandomMaps(1, 12'500, {24, 24});
}

TEST(NativeSearchTest, FindsTheReferenceCostOnLargerMaps) {
  ExpectAgreementOnRandomMaps(2, 1000, {90, 90});
}

TEST(NativeSearchTest, FindsTheReferenceCostWithCostsInTenths) {
  ExpectAgreementOnRandomMaps(3, 1500, {40, 40}, 0.1);
}

TEST(NativeSearchTest, FindsTheReferenceCostWithoutExactUnits) {
  ExpectAgreementOnRandomMaps(4, 1500, {40, 40}, 0.0123456789);
}

// Rows of more blocks than a word has bits, for each width of vectors.
TEST(NativeSearchTest, FindsTheReferenceCostOnWideMaps) {
  ExpectAgreementOnRandomMaps(6, 60, {2500, 8});
}

// Ground of one or two costs with a few walls: many paths are equally cheap.
TerrainMap OpenMap(Random& random, int max_side) {
  constexpr std::uint8_t kWall = 11;
  const int width = random.Int(1, max_side);
  const int height = random.Int(1, max_side);
  const auto other_ground = static_cast<std::uint8_t>(random.Int(0, 2));
  ByteRaster ids = ByteRaster::Zero(height, width);
  for (int i = random.Int(0, 8); i > 0; --i) {
    const int x = random.Int(0, width - 1);
    const int y = random.Int(0, height - 1);
    const int w = random.OneIn(2) ? 1 : random.Int(1, width / 3 + 1);
    const int h = random.OneIn(2) ? 1 : random.Int(1, height / 3 + 1);
    ids.block(y, x, std::min(h, height - y), std::min(w, width - x))
        .setConstant(random.OneIn(3) ? other_ground : kWall);
  }
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend(),
                            RandomCostModel(random))
      .value();
}

// AllWaysAgree compares cell for cell.
TEST(NativeSearchTest, EachWayTakesThePathOfTheTieRuleOnOpenMaps) {
  Random random(10);
  for (int i = 0; i < 3000; ++i) {
    TerrainMap map = OpenMap(random, i % 10 == 0 ? 120 : 30);
    if (!HasPassableCell(map)) continue;
    if (random.OneIn(4)) map = WithRandomCosts(random, map, 3, 0.0123456789);
    ASSERT_TRUE(AllWaysAgree(map, RandomPassableCell(random, map),
                             RandomPassableCell(random, map)))
        << "map " << i;
  }
}

// From the goal back: west while that is on a cheapest path, then the first
// step clockwise from west.
TEST(NativeSearchTest, TakesFromTheGoalBackTheStepStraightAheadIfItCan) {
  const TerrainMap map =
      TerrainMap::Create(ByteRaster::Zero(6, 9), MultiTerraPathLegend())
          .value();
  const CellPath want = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 3}, {5, 3}};
  const CellPath back = {{5, 3}, {4, 2}, {3, 1}, {2, 0}, {1, 0}, {0, 0}};
  for (const SearchWay& way : AllSearchWays()) {
    EXPECT_EQ(NativeSearch(map, {0, 0}, {5, 3}, way.options).cells, want)
        << way.name;
    EXPECT_EQ(NativeSearch(map, {5, 3}, {0, 0}, way.options).cells, back)
        << way.name;
  }
}

// By less than narrow keys can tell.
TEST(NativeSearchTest, ABoundBelowTheOptimumLeavesNoRoute) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const TerrainMap map =
        RandomMap(random, random.Int(2, 40), random.Int(2, 40),
                  RandomMapKind::kRectangles, RandomCostModel(random));
    if (!HasPassableCell(map)) continue;
    const Cell start = RandomPassableCell(random, map);
    const Cell goal = RandomPassableCell(random, map);
    const double optimum = NativeSearch(map, start, goal).cost;
    if (start == goal || optimum == kImpassable) continue;
    for (SearchWay way : AllSearchWays()) {
      way.options.upper_bound = (1 - 1e-8) * optimum;
      ASSERT_EQ(NativeSearch(map, start, goal, way.options).status,
                SearchStatus::kNoRoute)
          << way.name << ", map " << i;
    }
  }
}

// Few steps lead beyond narrow keys: their sums must neither wrap around nor
// lose paths.
TEST(NativeSearchTest, FindsTheReferenceCostWithTheDearestUnitsThatFitACode) {
  ExpectAgreementOnRandomMaps(5, 1500, {24, 24}, 1, CostGrid::kCodeMask);
}

// Sets of blocks are words of 64 bits, and a word's last block touches the next
// word's first. Walls at all these places, with gaps that only a diagonal step
// takes, let nothing else lead over.
TEST(NativeSearchTest, CrossesFromWordToWordOnADiagonalStepAlone) {
  constexpr std::uint8_t kWall = 11;
  constexpr int kFewestCellsOfAWord = 64 * 4;
  ByteRaster ids = ByteRaster::Zero(3, 9 * kFewestCellsOfAWord);
  for (int i = 1; i < 9; ++i) {
    const Eigen::Index x = Eigen::Index{i} * kFewestCellsOfAWord;
    ids.middleCols(x - 1, 2) = kWall;
    ids(1, x - 1) = 0;
    ids(i % 2 == 0 ? 0 : 2, x) = 0;
  }
  const TerrainMap map =
      TerrainMap::Create(ids, MultiTerraPathLegend()).value();
  const Cell west{0, 0};
  const Cell east{map.width() - 1, 2};
  ASSERT_TRUE(NativeSearch(map, west, east).found());
  EXPECT_TRUE(AllWaysAgree(map, west, east));
  EXPECT_TRUE(AllWaysAgree(map, east, west));
}

TEST(NativeSearchTest, FindsTheOnlyWayWhereItsLastStepLeavesNarrowKeys) {
  const Legend legend = Legend::Create({{0, "ground", 1, {0, 0, 0}},
                                        {1, "mud", 20'000, {9, 9, 9}}})
                            .value();
  ByteRaster ids(1, 4);
  ids << 0, 1, 1, 1;
  const TerrainMap map = TerrainMap::Create(ids, legend).value();
  EXPECT_TRUE(AllWaysAgree(map, {0, 0}, {3, 0}));
}

// Labels are cleared after every 255 searches only.
TEST(NativeSearchTest, StaysExactOverManySearchesInTheSameMemory) {
  Random random(9);
  const TerrainMap map = RandomMap(random, 40, 30, RandomMapKind::kRectangles);
  NativeSearcher kept;
  int found = 0;
  for (int i = 0; i < 600; ++i) {
    const Cell start{random.Int(0, 39), random.Int(0, 29)};
    const Cell goal{random.Int(0, 39), random.Int(0, 29)};
    const SearchResult got =
        kept.Search(map, start, goal, {.method = SearchMethod::kBuckets});
    const SearchResult want = ReferenceSearch(map, start, goal);
    ASSERT_EQ(got.status, want.status) << i;
    ASSERT_EQ(got.cost, want.cost) << i;
    found += got.found() ? 1 : 0;
  }
  EXPECT_GT(found, 100);
}

}  // namespace
}  // namespace terra

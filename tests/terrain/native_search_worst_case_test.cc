// Maps made to be hard for searches: long corridors, closed rooms, costs that
// differ from cell to cell. What is bounded is counted work, never time.

#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "benchmark/map_generator.h"
#include "benchmark/worst_case_maps.h"
#include "terrain/builtin_legends.h"
#include "terrain/native_search.h"
#include "terrain/reference_search.h"
#include "tests/terrain/search_agreement.h"

namespace terra {
namespace {

using benchmark::ClosedRoom;
using benchmark::ColumnSerpentine;
using benchmark::NoiseOfCosts;
using benchmark::RowSerpentine;
using benchmark::Spiral;
using benchmark::WorstCase;
using testing::AllSearchWays;
using testing::AllWaysAgree;
using testing::SearchWay;

constexpr std::uint8_t kDearest = 10;

TerrainMap MapOf(const WorstCase& c,
                 const Legend& legend = MultiTerraPathLegend()) {
  return TerrainMap::Create(c.ids, legend).value();
}

// Costs that are multiples of a tenth, up to 12.7: the units of a cell are five
// times those of the paper's legend.
Legend TenthsLegend() {
  std::vector<Terrain> terrains = MultiTerraPathLegend().terrains();
  for (Terrain& terrain : terrains) {
    if (terrain.cost != kImpassable) {
      terrain.cost = terrain.id == kDearest ? 12.7 : 1.1 + 0.3 * terrain.id;
    }
  }
  return Legend::Create(std::move(terrains)).value();
}

TEST(NativeSearchWorstCaseTest, AgreesOnLongCorridors) {
  for (const std::uint8_t ground : {std::uint8_t{0}, kDearest}) {
    for (const WorstCase& c : {RowSerpentine(500, ground), Spiral(500, ground),
                               ColumnSerpentine(500, ground)}) {
      EXPECT_TRUE(AllWaysAgree(MapOf(c), c.start, c.goal));
      EXPECT_TRUE(AllWaysAgree(MapOf(c), c.goal, c.start));
    }
  }
}

TEST(NativeSearchWorstCaseTest, AgreesOnLongCorridorsWithCostsInTenths) {
  const Legend legend = TenthsLegend();
  for (const std::uint8_t ground : {std::uint8_t{0}, kDearest}) {
    for (const WorstCase& c : {RowSerpentine(500, ground), Spiral(500, ground),
                               ColumnSerpentine(500, ground)}) {
      const TerrainMap map = MapOf(c, legend);
      ASSERT_EQ(map.costs().scale, 10);
      EXPECT_TRUE(AllWaysAgree(map, c.start, c.goal));
    }
  }
}

TEST(NativeSearchWorstCaseTest, AgreesThatAClosedRoomCannotBeReached) {
  const WorstCase c = ClosedRoom(300, 0);
  EXPECT_TRUE(AllWaysAgree(MapOf(c), c.start, c.goal));
  EXPECT_TRUE(AllWaysAgree(MapOf(c), c.goal, c.start));
  EXPECT_EQ(NativeSearch(MapOf(c), c.start, c.goal).status,
            SearchStatus::kNoRoute);
}

TEST(NativeSearchWorstCaseTest, AgreesWhereEveryCellCostsSomethingElse) {
  const WorstCase c = NoiseOfCosts(400, 5);
  EXPECT_TRUE(AllWaysAgree(MapOf(c), c.start, c.goal));
}

TEST(NativeSearchWorstCaseTest, AgreesOnGeneratedMaps) {
  using benchmark::Subset;
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    for (int i = 0; i < 8; ++i) {
      const benchmark::GeneratedCase drawn = benchmark::GenerateCase(
          subset, 5, i, benchmark::CalibratedParameters(subset));
      EXPECT_TRUE(AllWaysAgree(drawn.map, drawn.start, drawn.goal)) << i;
    }
  }
}

TEST(NativeSearchWorstCaseTest, AKnownCostBeyondNarrowKeysSkipsThem) {
  const WorstCase c = RowSerpentine(500, kDearest);
  const TerrainMap map = MapOf(c);
  const double cost = NativeSearch(map, c.start, c.goal).cost;
  const SearchResult known =
      NativeSearch(map, c.start, c.goal, {.upper_bound = cost});
  const SearchResult wide = NativeSearch(
      map, c.start, c.goal, {.upper_bound = cost, .keys = KeyWidth::kWide});
  EXPECT_EQ(known.cost, cost);
  EXPECT_EQ(known.expanded, wide.expanded);
}

TEST(NativeSearchWorstCaseTest, AKnownCostWithinNarrowKeysNeedsNoOthers) {
  const WorstCase c = RowSerpentine(100, 0);
  const TerrainMap map = MapOf(c);
  const double cost = NativeSearch(map, c.start, c.goal).cost;
  NativeSearcher searcher;
  const SearchResult narrow =
      searcher.Search(map, c.start, c.goal,
                      {.upper_bound = cost, .method = SearchMethod::kSweep});
  EXPECT_EQ(narrow.cost, cost);
  // Keys of 4 bytes a cell, none of the labels of 8 more that A* takes.
  EXPECT_LT(narrow.bytes, std::size_t{100 * 100 * 8});
}

// A* looks at eight neighbours of each cell it expands; a sweep relaxes a cell
// from its neighbours in one go. Each counts as one relaxation. (Where every
// cell costs something else a sweep makes more of them, but many at a time: its
// time is in docs/performance.md.)
TEST(NativeSearchWorstCaseTest, NoWayWorksMoreThanTwiceAsMuchAsPlainAStar) {
  for (const WorstCase& c :
       {RowSerpentine(500, 0), ColumnSerpentine(500, 0), Spiral(500, 0),
        ColumnSerpentine(500, kDearest), ClosedRoom(500, 0)}) {
    const TerrainMap map = MapOf(c);
    const std::int64_t plain =
        8 * ReferenceSearch(map, c.start, c.goal).expanded;
    for (const SearchWay& way : AllSearchWays()) {
      const SearchResult got = NativeSearch(map, c.start, c.goal, way.options);
      const bool sweep = got.passes > 0;
      EXPECT_LE(sweep ? got.expanded : 8 * got.expanded, 2 * plain) << way.name;
    }
  }
}

TEST(NativeSearchLargeMapTest, AgreesOnSerpentinesOf4000Cells) {
  for (const WorstCase& c :
       {RowSerpentine(4000, 0), ColumnSerpentine(4000, kDearest)}) {
    const TerrainMap map = MapOf(c);
    const double cost = ReferenceSearch(map, c.start, c.goal).cost;
    EXPECT_EQ(NativeSearch(map, c.start, c.goal).cost, cost);
    EXPECT_EQ(NativeSearch(map, c.start, c.goal, {.upper_bound = cost}).cost,
              cost);
  }
}

// Beyond all integer keys: a billion units.
TEST(NativeSearchLargeMapTest, AgreesOnASerpentineOf4000CellsInTenths) {
  const WorstCase c = RowSerpentine(4000, kDearest);
  const TerrainMap map = MapOf(c, TenthsLegend());
  const double cost = ReferenceSearch(map, c.start, c.goal).cost;
  ASSERT_GT(cost * map.costs().scale, 131'836'323);
  EXPECT_EQ(NativeSearch(map, c.start, c.goal).cost, cost);
  EXPECT_EQ(NativeSearch(map, c.start, c.goal, {.upper_bound = cost}).cost,
            cost);
}

}  // namespace
}  // namespace terra

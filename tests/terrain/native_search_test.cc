#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/legend.h"
#include "terrain/map.h"
#include "tests/support/random_map.h"
#include "tests/terrain/search_agreement.h"

namespace terra {
namespace {

using testing::AllWaysAgree;
using testing::Random;
using testing::RandomMapKind;

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

void ExpectAgreementOnRandomMaps(std::uint64_t seed, int count, int max_side,
                                 double smallest_part, int max_parts = 400) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<RandomMapKind>(random.Int(0, 2));
    TerrainMap map =
        RandomMap(random, random.Int(1, max_side), random.Int(1, max_side),
                  kind, RandomCostModel(random));
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

TEST(NativeSearchTest, FindsTheReferenceCostOnSmallMaps) {
  ExpectAgreementOnRandomMaps(1, 9000, 24, 0);
}

TEST(NativeSearchTest, FindsTheReferenceCostOnLargerMaps) {
  ExpectAgreementOnRandomMaps(2, 1000, 90, 0);
}

TEST(NativeSearchTest, FindsTheReferenceCostWithCostsInTenths) {
  ExpectAgreementOnRandomMaps(3, 1500, 40, 0.1);
}

TEST(NativeSearchTest, FindsTheReferenceCostWithoutExactUnits) {
  ExpectAgreementOnRandomMaps(4, 1500, 40, 0.0123456789);
}

// Few steps lead beyond narrow keys: their sums must neither wrap around nor
// lose paths.
TEST(NativeSearchTest, FindsTheReferenceCostWithTheDearestUnitsThatFitACode) {
  ExpectAgreementOnRandomMaps(5, 1500, 24, 1, CostGrid::kCodeMask);
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

}  // namespace
}  // namespace terra

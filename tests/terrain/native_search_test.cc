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

// The map's ids under another legend: random costs for the ids 0 to 10.
TerrainMap WithRandomCosts(Random& random, const TerrainMap& map,
                           double smallest_part) {
  std::vector<Terrain> terrains = map.legend().terrains();
  for (Terrain& terrain : terrains) {
    if (terrain.cost != kImpassable) {
      terrain.cost = random.Int(1, 400) * smallest_part;
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
                                 double smallest_part) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const auto kind = static_cast<RandomMapKind>(random.Int(0, 2));
    TerrainMap map =
        RandomMap(random, random.Int(1, max_side), random.Int(1, max_side),
                  kind, RandomCostModel(random));
    if (smallest_part != 0) {
      map = WithRandomCosts(random, map, smallest_part);
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

}  // namespace
}  // namespace terra

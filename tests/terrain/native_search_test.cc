#include "terrain/native_search.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/reference_search.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra {
namespace {

using testing::MapFromAscii;
using testing::Random;
using testing::RandomMapKind;

// Every way a search can be made, forced one by one.
struct Way {
  std::string name;
  NativeSearchOptions options;
};

std::vector<Way> AllWays() {
  std::vector<Way> ways;
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

// Says whether each way finds what the reference finds: the same cost, on a
// path of single steps that the cost rule accepts at that cost.
::testing::AssertionResult AllWaysAgree(const TerrainMap& map, Cell start,
                                        Cell goal) {
  const SearchResult want = ReferenceSearch(map, start, goal);
  for (Way way : AllWays()) {
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

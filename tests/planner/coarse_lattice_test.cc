#include "planner/coarse_lattice.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "tests/planner/eager_lattice.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra::planner {
namespace {

using testing::EagerPlan;
using testing::MapFromAscii;
using testing::PlanEagerly;
using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;
using testing::RandomPassableCell;

TerrainMap UniformMap(int width, int height) {
  ByteRaster ids(height, width);
  ids.setZero();
  return TerrainMap::Create(ids, MultiTerraPathLegend()).value();
}

CostModel RandomCostModel(Random& random) {
  return {.corner_cutting = !random.OneIn(3),
          .clearance_cells = random.OneIn(4) ? random.Int(1, 4) : 0};
}

// The same ids at other costs: multiples of `part`, few enough for many ties.
TerrainMap WithCosts(Random& random, const TerrainMap& map, double part) {
  std::vector<Terrain> terrains = map.legend().terrains();
  for (Terrain& terrain : terrains) {
    if (terrain.cost != kImpassable) terrain.cost = random.Int(5, 60) * part;
  }
  return TerrainMap::Create(map.ids(),
                            Legend::Create(std::move(terrains)).value(),
                            map.cost_model())
      .value();
}

struct Problem {
  TerrainMap map;
  Cell start;
  Cell goal;
  LatticeOptions options;
};

// Some map with two passable cells; drawn again where it has none.
Problem RandomProblem(Random& random, int max_side, int max_stride,
                      double part) {
  for (;;) {
    TerrainMap map = RandomMap(
        random, random.Int(1, max_side), random.Int(1, max_side),
        static_cast<RandomMapKind>(random.Int(0, 2)), RandomCostModel(random));
    if (part != 0) map = WithCosts(random, map, part);
    if ((map.classes() == 0).all()) continue;
    const Cell start = RandomPassableCell(random, map);
    const Cell goal = RandomPassableCell(random, map);
    const auto joints =
        static_cast<JointRule>(random.OneIn(2) ? 0 : random.Int(0, 2));
    return {std::move(map), start, goal, {random.Int(1, max_stride), joints}};
  }
}

::testing::AssertionResult IsTheEagerPlan(const Problem& problem) {
  const LatticePlan got =
      PlanOnLattice(problem.map, problem.start, problem.goal, problem.options);
  if (problem.start == problem.goal) {
    const bool stays = got.found() && got.cost == 0 &&
                       got.waypoints == Route{problem.start, problem.goal};
    return stays ? ::testing::AssertionSuccess()
                 : ::testing::AssertionFailure() << "start = goal";
  }
  const EagerPlan want =
      PlanEagerly(problem.map, problem.start, problem.goal, problem.options);
  const auto fail = [&](const std::string& what) {
    return ::testing::AssertionFailure()
           << what << ", stride " << problem.options.stride << ", joint rule "
           << static_cast<int>(problem.options.joints) << "\n  got "
           << FormatRoute(got.waypoints) << " " << got.cost << "\n  want "
           << FormatRoute(want.waypoints) << " " << want.cost.value();
  };
  if (got.found() != want.found) return fail("one of them found no route");
  if (!want.found) {
    return got.status == SearchStatus::kNoRoute && got.waypoints.empty()
               ? ::testing::AssertionSuccess()
               : fail("a route of no status");
  }
  if (got.waypoints != want.waypoints) return fail("another route");
  if (std::abs(got.cost - want.cost.value()) > 1e-9 * got.cost) {
    return fail("another cost");
  }
  const RouteWalk walk = WalkRoute(problem.map, got.waypoints);
  if (!walk.feasible() || walk.cost != got.cost) {
    return fail("not what the cost rule says");
  }
  return ::testing::AssertionSuccess();
}

void ExpectEagerPlans(std::uint64_t seed, int count, int max_side,
                      int max_stride, double part) {
  Random random(seed);
  int found = 0;
  for (int i = 0; i < count; ++i) {
    const Problem p = RandomProblem(random, max_side, max_stride, part);
    ASSERT_TRUE(IsTheEagerPlan(p)) << "problem " << i << " of seed " << seed;
    found += PlanOnLattice(p.map, p.start, p.goal, p.options).found() ? 1 : 0;
  }
  // Routes and their absence are both put to the test.
  EXPECT_GT(found, count / 4);
  EXPECT_LT(found, count);
}

TEST(CoarseLatticeTest, PlansWhatAnEagerLatticePlansOnTheFinestStrides) {
  ExpectEagerPlans(1, 800, 24, 4, 0);
}

TEST(CoarseLatticeTest, PlansWhatAnEagerLatticePlansOnMiddleStrides) {
  ExpectEagerPlans(2, 800, 70, 20, 0);
}

TEST(CoarseLatticeTest, PlansWhatAnEagerLatticePlansOnCoarseStrides) {
  ExpectEagerPlans(3, 250, 260, 100, 0);
}

TEST(CoarseLatticeTest, PlansWhatAnEagerLatticePlansWithCostsInTenths) {
  ExpectEagerPlans(4, 800, 60, 15, 0.1);
}

TEST(CoarseLatticeTest, PlansWhatAnEagerLatticePlansWithCostsInThousandths) {
  ExpectEagerPlans(5, 400, 60, 15, 0.001);
}

TEST(CoarseLatticeTest, IsNeverCheaperThanTheNativeOptimum) {
  Random random(6);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const Problem p = RandomProblem(random, 80, 12, 0);
    const LatticePlan plan = PlanOnLattice(p.map, p.start, p.goal, p.options);
    const SearchResult oracle = NativeSearch(p.map, p.start, p.goal);
    if (!plan.found()) continue;
    ++found;
    ASSERT_TRUE(oracle.found());
    ASSERT_LE(oracle.cost, plan.cost) << "problem " << i;
  }
  EXPECT_GT(found, 100);
}

TEST(CoarseLatticeTest, OfStrideOneIsTheNativeOptimum) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Problem p = RandomProblem(random, 30, 1, 0);
    ASSERT_EQ(PlanOnLattice(p.map, p.start, p.goal, {.stride = 1}).cost,
              NativeSearch(p.map, p.start, p.goal).cost)
        << "problem " << i;
  }
}

TEST(CoarseLatticeTest, CostsAreRightWhereTheLegendHasNoExactUnits) {
  constexpr double kNoUnit = 0.0123456789;
  Random random(8);
  for (int i = 0; i < 150; ++i) {
    // Thousandths for the eager lattice, the same times a factor for ours.
    const Problem p = RandomProblem(random, 50, 10, 0.001);
    std::vector<Terrain> terrains = p.map.legend().terrains();
    for (Terrain& terrain : terrains) terrain.cost *= kNoUnit * 1000;
    const TerrainMap scaled =
        TerrainMap::Create(p.map.ids(),
                           Legend::Create(std::move(terrains)).value(),
                           p.map.cost_model())
            .value();
    ASSERT_EQ(scaled.costs().scale, 0);
    if (p.start == p.goal) continue;
    const EagerPlan want = PlanEagerly(p.map, p.start, p.goal, p.options);
    const LatticePlan got = PlanOnLattice(scaled, p.start, p.goal, p.options);
    ASSERT_EQ(got.found(), want.found);
    if (!want.found) continue;
    const double want_cost = want.cost.value() * kNoUnit * 1000;
    ASSERT_NEAR(got.cost, want_cost, 1e-12 * want_cost) << "problem " << i;
  }
}

// Golden routes: they are drawn and described to people and models, so ties
// must not be broken another way by accident.
TEST(CoarseLatticeTest, TiesTakeTheSmallestNodeSequence) {
  const TerrainMap map = UniformMap(200, 1);
  // 33 reaches 0 to 100, 187 is reached from 100 and 150; every way onward
  // costs the same.
  EXPECT_EQ(FormatRoute(PlanOnLattice(map, {33, 0}, {187, 0}).waypoints),
            "[(33, 0), (50, 0), (100, 0), (150, 0), (187, 0)]");
  EXPECT_EQ(FormatRoute(PlanOnLattice(map, {187, 0}, {33, 0}).waypoints),
            "[(187, 0), (100, 0), (33, 0)]");
}

TEST(CoarseLatticeTest, TiesInThePlaneGoAlongTheUpperRowsFirst) {
  const TerrainMap map = UniformMap(41, 41);
  EXPECT_EQ(FormatRoute(
                PlanOnLattice(map, {0, 0}, {40, 20}, {.stride = 10}).waypoints),
            "[(0, 0), (10, 0), (20, 0), (30, 10), (40, 20)]");
  EXPECT_EQ(FormatRoute(
                PlanOnLattice(map, {40, 20}, {0, 0}, {.stride = 10}).waypoints),
            "[(40, 20), (20, 0), (0, 0)]");
}

TEST(CoarseLatticeTest, JoinsReachTwoStridesAndNoFarther) {
  // Free but for the lattice nodes; only the one at (20, 0) is left.
  ByteRaster ids = ByteRaster::Zero(3, 50);
  constexpr std::uint8_t kObstacle = 11;
  for (const int x : {0, 10, 30, 40}) ids(0, x) = kObstacle;
  const TerrainMap map =
      TerrainMap::Create(ids, MultiTerraPathLegend()).value();
  const LatticeOptions options{.stride = 10};
  EXPECT_EQ(FormatRoute(PlanOnLattice(map, {0, 2}, {40, 2}, options).waypoints),
            "[(0, 2), (20, 0), (40, 2)]");
  EXPECT_FALSE(PlanOnLattice(map, {0, 2}, {41, 2}, options).found());
  EXPECT_FALSE(PlanOnLattice(map, {41, 2}, {0, 2}, options).found());
  // Start to goal without any node: within two strides.
  EXPECT_EQ(FormatRoute(PlanOnLattice(map, {2, 2}, {4, 2}, options).waypoints),
            "[(2, 2), (4, 2)]");
}

TEST(CoarseLatticeTest, SaysWhyThereIsNoRoute) {
  const TerrainMap map = MapFromAscii({"11#11", "11#11"});
  const auto status = [&](Cell start, Cell goal) {
    const LatticePlan plan = PlanOnLattice(map, start, goal, {.stride = 1});
    EXPECT_TRUE(plan.waypoints.empty());
    EXPECT_EQ(plan.cost, kImpassable);
    return plan.status;
  };
  EXPECT_EQ(status({0, 0}, {4, 0}), SearchStatus::kNoRoute);
  EXPECT_EQ(status({-1, 0}, {4, 0}), SearchStatus::kStartOutside);
  EXPECT_EQ(status({0, 0}, {0, 2}), SearchStatus::kGoalOutside);
  EXPECT_EQ(status({2, 0}, {4, 0}), SearchStatus::kStartBlocked);
  EXPECT_EQ(status({0, 0}, {2, 1}), SearchStatus::kGoalBlocked);
}

TEST(CoarseLatticeTest, StrideOutOfRangeIsABug) {
  const TerrainMap map = UniformMap(3, 3);
  EXPECT_THROW(PlanOnLattice(map, {0, 0}, {2, 2}, {.stride = 0}),
               std::logic_error);
  EXPECT_THROW(PlanOnLattice(map, {0, 0}, {2, 2}, {.stride = 8193}),
               std::logic_error);
}

}  // namespace
}  // namespace terra::planner

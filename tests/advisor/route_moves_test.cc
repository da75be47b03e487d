#include "advisor/route_moves.h"

#include <gtest/gtest.h>

#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"
#include "tests/advisor/refine_problem.h"
#include "tests/support/ascii_map.h"

namespace terra::advisor {
namespace {

using testing::MapFromAscii;
using testing::Random;
using testing::RandomRefineProblem;
using testing::RefineProblem;

Cell RandomCell(Random& random, const TerrainMap& map) {
  return {random.Int(0, map.width() - 1), random.Int(0, map.height() - 1)};
}

TEST(SegmentCostBelowTest, IsTheSegmentCostOnBothSidesOfTheLimit) {
  Random random(1);
  int below = 0;
  for (int i = 0; i < 3000; ++i) {
    const TerrainMap map = RandomRefineProblem(random, 30).map;
    const Cell from = RandomCell(random, map);
    const Cell to = RandomCell(random, map);
    const double cost = SegmentCost(map, from, to);
    if (cost == kImpassable) {
      EXPECT_EQ(SegmentCostBelow(map, from, to, kImpassable), kImpassable);
      continue;
    }
    ++below;
    EXPECT_NEAR(SegmentCostBelow(map, from, to, kImpassable), cost, 1e-9);
    EXPECT_NEAR(SegmentCostBelow(map, from, to, cost + 1e-6), cost, 1e-9);
    EXPECT_EQ(SegmentCostBelow(map, from, to, cost - 1e-6), kImpassable);
  }
  EXPECT_GT(below, 300);
}

TEST(DensifyTest, KeepsTheWaypointsAndLeavesOutRepetitions) {
  EXPECT_EQ(FormatRoute(Densify({{0, 0}, {0, 0}, {7, 0}, {7, 2}, {7, 2}}, 3)),
            "[(0, 0), (3, 0), (6, 0), (7, 0), (7, 2)]");
  EXPECT_EQ(FormatRoute(Densify({{4, 4}, {4, 4}}, 3)), "[(4, 4), (4, 4)]");
}

TEST(ThinWaypointsTest, KeepsCostAndEndsWithFewerWaypoints) {
  Random random(2);
  std::size_t before = 0;
  std::size_t after = 0;
  for (int i = 0; i < 200; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    const Route thinned =
        ThinWaypoints(problem.baseline, [&](Cell from, Cell to) {
          return SegmentCost(problem.map, from, to);
        });
    EXPECT_LE(WalkRoute(problem.map, thinned).cost,
              problem.baseline_cost + 1e-6);
    EXPECT_EQ(thinned.front(), problem.baseline.front());
    EXPECT_EQ(thinned.back(), problem.baseline.back());
    before += problem.baseline.size();
    after += thinned.size();
  }
  EXPECT_LT(after, before);
}

TEST(ThinWaypointsTest, KeepsAWaypointThatAvoidsDearTerrain) {
  const TerrainMap map = MapFromAscii({
      "11111",
      "19991",
      "19991",
  });
  const Route around = {{0, 2}, {0, 0}, {2, 0}, {4, 0}, {4, 2}};
  EXPECT_EQ(FormatRoute(ThinWaypoints(around,
                                      [&](Cell from, Cell to) {
                                        return SegmentCost(map, from, to);
                                      })),
            "[(0, 2), (0, 0), (4, 0), (4, 2)]");
}

TEST(PerturbWaypointsTest, OnlyEverLowersTheCost) {
  Random random(3);
  int moved = 0;
  for (int i = 0; i < 200; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    Route route = problem.baseline;
    PerturbWaypoints(problem.map, route, {});
    const double cost = WalkRoute(problem.map, route).cost;
    EXPECT_LE(cost, problem.baseline_cost + 1e-9);
    EXPECT_EQ(route.size(), problem.baseline.size());
    EXPECT_EQ(route.front(), problem.baseline.front());
    EXPECT_EQ(route.back(), problem.baseline.back());
    moved += cost < problem.baseline_cost - 1e-6 ? 1 : 0;
  }
  EXPECT_GT(moved, 50);
}

}  // namespace
}  // namespace terra::advisor

#include "terrain/route_cost.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "terrain/segment.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra {
namespace {

using std::numbers::sqrt2;
using testing::MapFromAscii;
using testing::Random;

constexpr CostModel kNoCutting = {.corner_cutting = false};

TEST(RouteCostTest, ChargesTheCellEnteredAndNotTheFirst) {
  const TerrainMap map = MapFromAscii({"911"});
  EXPECT_DOUBLE_EQ(SegmentCost(map, {0, 0}, {2, 0}), 2);
  EXPECT_DOUBLE_EQ(SegmentCost(map, {2, 0}, {0, 0}), 10);
}

TEST(RouteCostTest, DiagonalStepsAreLongerBySqrtTwo) {
  const TerrainMap map = MapFromAscii({"1111", "1311", "1121"});
  EXPECT_DOUBLE_EQ(SegmentCost(map, {0, 0}, {2, 2}), 5 * sqrt2);
}

TEST(RouteCostTest, StandingStillIsFree) {
  const TerrainMap map = MapFromAscii({"9"});
  EXPECT_DOUBLE_EQ(SegmentCost(map, {0, 0}, {0, 0}), 0);
}

TEST(RouteCostTest, FirstFailingCellInTravelOrderIsNamed) {
  const TerrainMap map = MapFromAscii({"1111", "11#1", "1111"});
  const Route route = {{0, 0}, {0, 1}, {3, 1}, {9, 1}};
  const RouteWalk walk = WalkRoute(map, route);
  EXPECT_EQ(walk.fault, RouteFault::kObstacle);
  EXPECT_EQ(walk.segment, 1);
  EXPECT_EQ(walk.cell, (Cell{2, 1}));
  EXPECT_EQ(walk.steps, 2);
  EXPECT_EQ(walk.cost, kImpassable);
}

TEST(RouteCostTest, LeavingTheMapIsNamedAtTheFirstCellOutside) {
  const TerrainMap map = MapFromAscii({"111"});
  const RouteWalk walk = WalkRoute(map, Route{{0, 0}, {2'000'000'000, 0}});
  EXPECT_EQ(walk.fault, RouteFault::kOutOfBounds);
  EXPECT_EQ(walk.cell, (Cell{3, 0}));
}

TEST(RouteCostTest, BlockedStartFailsAtSegmentZero) {
  const TerrainMap map = MapFromAscii({"#1"});
  const RouteWalk walk = WalkRoute(map, Route{{0, 0}, {1, 0}});
  EXPECT_EQ(walk.fault, RouteFault::kObstacle);
  EXPECT_EQ(walk.segment, 0);
  EXPECT_EQ(walk.cell, (Cell{0, 0}));
}

TEST(RouteCostTest, CornerCuttingIsTheCostModelsChoice) {
  EXPECT_TRUE(
      WalkRoute(MapFromAscii({"1#", "#1"}), Route{{0, 0}, {1, 1}}).feasible());
  EXPECT_EQ(
      WalkRoute(MapFromAscii({"1#", "11"}, kNoCutting), Route{{0, 0}, {1, 1}})
          .fault,
      RouteFault::kObstacle);
}

TEST(RouteCostTest, StepLimitStopsTheWalk) {
  const TerrainMap map = MapFromAscii({"11111"});
  EXPECT_TRUE(WalkRoute(map, Route{{0, 0}, {4, 0}}, 4).feasible());
  EXPECT_EQ(WalkRoute(map, Route{{0, 0}, {4, 0}}, 3).fault,
            RouteFault::kWorkLimit);
}

TEST(RouteCostTest, CostDoesNotDependOnHowTheCellsAreCutIntoSegments) {
  Random random(7);
  const TerrainMap map =
      RandomMap(random, 40, 30, testing::RandomMapKind::kRectangles);
  for (int i = 0; i < 200; ++i) {
    const Route route = {RandomPassableCell(random, map),
                         RandomPassableCell(random, map),
                         RandomPassableCell(random, map)};
    const RouteWalk walk = WalkRoute(map, route);
    if (walk.feasible()) {
      EXPECT_EQ(WalkRoute(map, RasterizeRoute(route)).cost, walk.cost);
    }
  }
}

// A second, naive reading of the cost rule.
TEST(RouteCostTest, AgreesWithANaiveSum) {
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const TerrainMap map =
        RandomMap(random, 25, 25, testing::RandomMapKind::kNoise);
    const Route route = {RandomPassableCell(random, map),
                         RandomPassableCell(random, map)};
    double cost = 0;
    const CellPath cells = RasterizeRoute(route);
    for (std::size_t k = 1; k < cells.size(); ++k) {
      const double length =
          std::hypot(cells[k].x - cells[k - 1].x, cells[k].y - cells[k - 1].y);
      cost +=
          length * map.legend().Find(map.ids()(cells[k].y, cells[k].x))->cost;
    }
    const RouteWalk walk = WalkRoute(map, route);
    EXPECT_EQ(walk.feasible(), std::isfinite(cost));
    if (walk.feasible()) {
      EXPECT_NEAR(walk.cost, cost, 1e-9 * (1 + cost));
    }
  }
}

}  // namespace
}  // namespace terra

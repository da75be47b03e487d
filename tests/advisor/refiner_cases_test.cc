// What single refiners do on maps drawn by hand.
#include <cmath>

#include <gtest/gtest.h>

#include "advisor/refiners.h"
#include "benchmark/methods/comparison_refiners.h"
#include "benchmark/methods/controls.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"
#include "tests/support/ascii_map.h"

namespace terra::advisor {
namespace {

using benchmark::CampanaForm;
using benchmark::RefineByAppStyle;
using benchmark::RefineByCampana;
using benchmark::ShortcutWithoutCost;

using testing::MapFromAscii;

// A road of cost 1, six cells wide, around a field of cost 9.
TerrainMap RoadAroundAField() {
  ByteRaster ids = ByteRaster::Constant(41, 81, 1);
  ids.block(6, 6, 29, 69) = 9;
  return TerrainMap::Create(ids, testing::AsciiLegend()).value();
}
const Route kRoad = {{2, 20}, {2, 2}, {40, 2}, {78, 2}, {78, 20}};

TEST(ShortcutTest, StaysOnTheRoadWhereTheStraightLineIsDearer) {
  const TerrainMap map = RoadAroundAField();
  const double cost = WalkRoute(map, kRoad).cost;
  const RefineInput input{map, kRoad, cost};
  for (const auto& refine : {RefineByShortcut, RefineByAppStyle}) {
    const RefineOutput refined = refine(input);
    // Two corners are cut, at 2 - sqrt 2 a diagonal step.
    EXPECT_LT(refined.cost, cost - 4);
    for (const Cell c : RasterizeRoute(refined.route)) {
      EXPECT_EQ(map.Cost(c), 1) << ToString(c);
    }
  }
  EXPECT_GT(ShortcutWithoutCost(input).cost, 2 * cost);
}

TEST(ShortcutTest, TakesTheStraightLineOnOpenGround) {
  const TerrainMap map = MapFromAscii({"11111", "11111", "11111"});
  const Route bent = {{0, 0}, {0, 2}, {4, 2}, {4, 0}};
  for (const auto& refine :
       {RefineByShortcut, RefineByAppStyle, RefineBySearch}) {
    const RefineOutput refined = refine({map, bent, 8});
    EXPECT_DOUBLE_EQ(refined.cost, 4);
    EXPECT_EQ(FormatRoute(refined.route), "[(0, 0), (4, 0)]");
  }
  EXPECT_EQ(FormatRoute(ShortcutWithoutCost({map, bent, 8}).route),
            "[(0, 0), (4, 0)]");
}

double Length(const Route& route) {
  double length = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    length +=
        std::hypot(route[i].x - route[i - 1].x, route[i].y - route[i - 1].y);
  }
  return length;
}

TerrainMap OpenGround(int width, int height) {
  ByteRaster ids = ByteRaster::Constant(height, width, 1);
  return TerrainMap::Create(ids, testing::AsciiLegend()).value();
}

TEST(CampanaTest, DrawsTheRouteStraightOnOpenGround) {
  const TerrainMap map = OpenGround(101, 61);
  const Route bent = {{0, 30}, {20, 10}, {50, 50}, {80, 5}, {100, 30}};
  const double cost = WalkRoute(map, bent).cost;
  const RefineOutput last =
      RefineByCampana({map, bent, cost}, CampanaForm::kLastIterate);
  ASSERT_EQ(last.route.size(), bent.size());
  for (const Cell c : last.route) EXPECT_EQ(c.y, 30);
  EXPECT_DOUBLE_EQ(last.cost, 100);
}

TEST(CampanaTest, SlidesAlongAnObstacle) {
  ByteRaster ids = ByteRaster::Constant(61, 101, 1);
  ids.block(20, 40, 41, 20) = 0;  // A block from below up to row 20.
  const TerrainMap map =
      TerrainMap::Create(ids, testing::AsciiLegend()).value();
  const Route around = {{5, 50}, {30, 10}, {50, 2}, {70, 10}, {95, 50}};
  const double cost = WalkRoute(map, around).cost;
  const RefineOutput last =
      RefineByCampana({map, around, cost}, CampanaForm::kLastIterate);
  EXPECT_LT(last.cost, cost);
  EXPECT_LT(Length(last.route), Length(around) - 5);
  // Nobody goes through it.
  EXPECT_GT(Length(last.route), 2 * std::hypot(35, 31) + 18);
}

TEST(CampanaTest, LengthObjectiveLeavesTheRoadAndKeepBestDoesNot) {
  const TerrainMap map = RoadAroundAField();
  const double cost = WalkRoute(map, kRoad).cost;
  const RefineInput input{map, kRoad, cost};
  EXPECT_GT(RefineByCampana(input, CampanaForm::kLastIterate).cost, cost);
  EXPECT_LE(RefineByCampana(input, CampanaForm::kKeepBest).cost, cost);
}

TEST(CampanaTest, CannotMoveARouteWithoutInnerWaypoints) {
  const TerrainMap map = OpenGround(9, 9);
  const Route line = {{0, 0}, {0, 0}, {8, 3}, {8, 3}};
  const double cost = WalkRoute(map, line).cost;
  EXPECT_EQ(RefineByCampana({map, line, cost}, CampanaForm::kLastIterate).route,
            line);
}

}  // namespace
}  // namespace terra::advisor

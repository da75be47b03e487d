#include "terrain/driven_route.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra {
namespace {

using testing::Random;

DrivenRoute Driving(const Route& waypoints) {
  DrivenRoute route;
  route.Follow(waypoints);
  return route;
}

// The index that the robot has reached.
int PlaceOf(const DrivenRoute& route, int count) {
  for (int i = 0; i < count; ++i) {
    if (!route.Passed(i)) return i;
  }
  return -1;
}

TEST(DrivenRouteTest, BeginsAtTheStart) {
  const DrivenRoute route = Driving({{0, 0}, {9, 0}});
  EXPECT_FALSE(route.Passed(0));
  EXPECT_FALSE(route.Passed(9));
  EXPECT_TRUE(route.Passed(10));
  EXPECT_TRUE(route.Passed(-1));
  EXPECT_TRUE(route.Passed(std::numeric_limits<int>::min()));
  EXPECT_TRUE(route.Passed(std::numeric_limits<int>::max()));
  EXPECT_EQ(route.cell(4), (Cell{4, 0}));
}

TEST(DrivenRouteTest, WithoutARouteEverythingIsPassed) {
  DrivenRoute route;
  EXPECT_TRUE(route.Passed(0));
  route.OnPose({0, 0});
  route.Follow({});
  EXPECT_TRUE(route.Passed(0));
}

TEST(DrivenRouteTest, PosesMoveThePlaceForwardOnly) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({4, 1});
  EXPECT_EQ(PlaceOf(route, 10), 4);
  route.OnPose({2, 0});
  EXPECT_EQ(PlaceOf(route, 10), 4);
  EXPECT_TRUE(route.Passed(3));
  EXPECT_FALSE(route.Passed(4)) << "the robot is there, not past it";
}

TEST(DrivenRouteTest, BothSidesOfTheTolerance) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({4, DrivenRoute::kToleranceCells});
  EXPECT_EQ(PlaceOf(route, 10), 4);
  route.OnPose({6, DrivenRoute::kToleranceCells + 1});
  EXPECT_EQ(PlaceOf(route, 10), -1) << "off the route";
  route.OnPose({6, 0});
  EXPECT_EQ(PlaceOf(route, 10), 6) << "on it again";
}

TEST(DrivenRouteTest, PosesAtTheEndsOfTheNumbersAreOffTheRoute) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({std::numeric_limits<int>::min(), 0});
  EXPECT_EQ(PlaceOf(route, 10), -1);
  route.OnPose({0, std::numeric_limits<int>::max()});
  EXPECT_EQ(PlaceOf(route, 10), -1);
}

// Out along y = 0, back along y = 1 to the cells above the start.
TEST(DrivenRouteTest, ARouteThatComesBackKeepsItsPlace) {
  DrivenRoute route = Driving({{0, 0}, {100, 0}, {100, 1}, {0, 1}});
  route.OnPose({1, 1});
  EXPECT_EQ(PlaceOf(route, 202), 1) << "not index 200";
  route.OnPose({40, 0});
  EXPECT_EQ(PlaceOf(route, 202), 40);
}

TEST(DrivenRouteTest, ARobotBeyondTheWindowIsFoundAgain) {
  DrivenRoute route = Driving({{0, 0}, {400, 0}});
  route.OnPose({300, 0});
  EXPECT_EQ(PlaceOf(route, 401), 295) << "the first cell within the tolerance";
  route.OnPose({300, 0});
  EXPECT_EQ(PlaceOf(route, 401), 300);
}

TEST(DrivenRouteTest, OfEquallyNearCellsTheLastCounts) {
  DrivenRoute route = Driving({{0, 0}, {4, 0}, {4, 2}, {0, 2}});
  route.OnPose({2, 1});
  EXPECT_EQ(PlaceOf(route, 11), 8);
}

TEST(DrivenRouteTest, ANewRouteWithTheSameWaySoFarKeepsThePlace) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({4, 0});
  route.Follow({{0, 0}, {4, 0}, {9, 5}});
  EXPECT_EQ(PlaceOf(route, 10), 4);
  route.Follow({{0, 0}, {3, 0}, {3, 6}});
  EXPECT_EQ(PlaceOf(route, 10), 0) << "parts before the robot";
}

TEST(DrivenRouteTest, ARouteThatPartsBeforeTheRobotStartsAnew) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({5, 0});
  route.OnPose({50, 50});
  route.Follow({{0, 0}, {2, 0}});
  EXPECT_EQ(PlaceOf(route, 3), 0) << "too short to hold the place";
}

TEST(DrivenRouteTest, OffTheRouteStaysOffWhileTheWayIsTheSame) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({50, 50});
  route.Follow({{0, 0}, {9, 0}, {9, 0}});
  EXPECT_TRUE(route.Passed(0));
}

TEST(DrivenRouteTest, CostFromAnIndexIsTheRestOfTheCost) {
  const TerrainMap map = testing::MapFromAscii({"12345"});
  const DrivenRoute route = Driving({{0, 0}, {4, 0}});
  EXPECT_EQ(route.CostFrom(map, 0), 14);
  EXPECT_EQ(route.CostFrom(map, 2), 9);
  EXPECT_EQ(route.CostFrom(map, 4), 0);
}

TEST(DrivenRouteTest, JoiningAtTheStartIsTheTailItself) {
  const DrivenRoute route = Driving({{0, 0}, {0, 0}, {9, 3}});
  const Route tail = {{0, 0}, {5, 5}, {9, 3}};
  EXPECT_EQ(route.JoinAt(0, tail), tail);
}

TEST(DrivenRouteTest, JoiningInsideASegmentKeepsItsCells) {
  Random random(30);
  for (int i = 0; i < 500; ++i) {
    const auto cell = [&random] {
      return Cell{random.Int(0, 30), random.Int(0, 30)};
    };
    Route waypoints = {cell(), cell(), cell(), cell()};
    if (random.OneIn(4)) waypoints[1] = waypoints[0];
    const DrivenRoute route = Driving(waypoints);
    const CellPath cells = RasterizeRoute(waypoints);
    const int index = random.Int(0, static_cast<int>(cells.size()) - 1);
    const Route tail = {cells[static_cast<std::size_t>(index)], cell(), cell()};
    CellPath expected(cells.begin(), cells.begin() + index);
    const CellPath rest = RasterizeRoute(tail);
    expected.insert(expected.end(), rest.begin(), rest.end());
    ASSERT_EQ(RasterizeRoute(route.JoinAt(index, tail)), expected) << i;
  }
}

TEST(DrivenRouteTest, JoiningDropsRepeatedWaypoints) {
  Route padded(2'000, Cell{0, 0});
  padded.push_back({9, 0});
  const DrivenRoute route = Driving(padded);
  EXPECT_EQ(route.JoinAt(4, {{4, 0}, {9, 0}}), (Route{{0, 0}, {4, 0}, {9, 0}}));
}

TEST(DrivenRouteTest, PassedCellsCannotBeUsed) {
  DrivenRoute route = Driving({{0, 0}, {9, 0}});
  route.OnPose({4, 0});
  EXPECT_THROW(route.cell(3), std::logic_error);
  EXPECT_THROW(route.JoinAt(3, {{3, 0}, {9, 0}}), std::logic_error);
  EXPECT_THROW(route.JoinAt(5, {{6, 0}, {9, 0}}), std::logic_error);
}

}  // namespace
}  // namespace terra

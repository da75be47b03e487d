#include "advisor/corridor.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "advisor/polish.h"
#include "terrain/reference_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"
#include "tests/advisor/refine_problem.h"
#include "tests/support/ascii_map.h"
#include "tests/terrain/ruled_path.h"

namespace terra::advisor {
namespace {

using testing::MapFromAscii;
using testing::Random;
using testing::RandomRefineProblem;
using testing::RefineProblem;
using testing::RuledPath;

bool IsNear(const CellPath& path, Cell c, int distance) {
  return std::any_of(path.begin(), path.end(), [&](Cell at) {
    return ChebyshevDistance(at, c) <= distance;
  });
}

TEST(CorridorTest, HoldsTheCellsNearTheRasterAndNoOthers) {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 40);
    const int half_width = random.Int(0, 12);
    const std::array<Route, 2> routes = {
        problem.baseline, Route{{0, 0}, {problem.map.width() - 1, 0}}};
    const Corridor corridor(problem.map, routes, half_width);
    const CellPath first = RasterizeRoute(routes[0]);
    const CellPath second = RasterizeRoute(routes[1]);
    for (int y = -1; y <= problem.map.height(); ++y) {
      for (int x = -1; x <= problem.map.width(); ++x) {
        const Cell c{x, y};
        ASSERT_EQ(corridor.Contains(c),
                  problem.map.Contains(c) && (IsNear(first, c, half_width) ||
                                              IsNear(second, c, half_width)))
            << ToString(c);
      }
    }
  }
}

// The same map with an obstacle outside the corridor.
TerrainMap Walled(const TerrainMap& map, const Corridor& corridor) {
  constexpr std::uint8_t kObstacleId = 11;
  ByteRaster ids = map.ids();
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (!map.Passable({x, y}) || !corridor.Contains({x, y})) {
        ids(y, x) = kObstacleId;
      }
    }
  }
  return TerrainMap::Create(std::move(ids), map.legend()).value();
}

TEST(CorridorTest, SearchFindsTheOptimumOfTheMapWalledInToTheCorridor) {
  Random random(2);
  int checked = 0;
  for (int i = 0; i < 400; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 50);
    // Where corners may not be cut, a wall would block more than the corridor.
    if (!problem.map.cost_model().corner_cutting) continue;
    const Corridor corridor(problem.map, std::array{problem.baseline},
                            random.Int(0, 8));
    const Cell start = problem.baseline.front();
    const Cell goal = problem.baseline.back();
    const TerrainMap walled = Walled(problem.map, corridor);
    const SearchResult want = ReferenceSearch(walled, start, goal);
    const SearchResult got = SearchCorridor(problem.map, corridor, start, goal);
    ASSERT_EQ(got.status, want.status);
    ASSERT_NEAR(got.cost, want.cost, 1e-9 * want.cost);
    ASSERT_EQ(got.cells, RuledPath(walled, start, goal));
    ASSERT_TRUE(std::all_of(got.cells.begin(), got.cells.end(), [&](Cell c) {
      return corridor.Contains(c);
    }));
    ASSERT_NEAR(WalkRoute(problem.map,
                          RouteInCorridor(problem.map, corridor, start, goal))
                    .cost,
                want.cost, 1e-9 * want.cost);
    ++checked;
  }
  EXPECT_GT(checked, 200);
}

TEST(CorridorTest, EndsOutsideHaveNoRoute) {
  const TerrainMap map = MapFromAscii({"111", "111", "111"});
  const Corridor corridor(map, std::array{Route{{0, 0}, {2, 0}}}, 0);
  EXPECT_TRUE(RouteInCorridor(map, corridor, {0, 0}, {2, 1}).empty());
  EXPECT_TRUE(RouteInCorridor(map, corridor, {0, 2}, {2, 0}).empty());
}

TEST(PolishTest, IsNoDearerThanBaselineAndValidProposal) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    const Cell start = problem.baseline.front();
    const Cell goal = problem.baseline.back();
    Route proposal = {start};
    for (int k = random.Int(0, 3); k > 0; --k) {
      proposal.push_back({random.Int(-5, 65), random.Int(-5, 65)});
    }
    proposal.push_back(goal);
    const RefineOutput polished =
        Polish(problem.input(), proposal, random.Int(0, 10));
    const RouteWalk walk = WalkRoute(problem.map, polished.route);
    ASSERT_TRUE(walk.feasible());
    ASSERT_EQ(walk.cost, polished.cost);
    ASSERT_EQ(polished.route.front(), start);
    ASSERT_EQ(polished.route.back(), goal);
    ASSERT_LE(polished.cost, problem.baseline_cost);
    const RouteWalk raw = WalkRoute(problem.map, proposal);
    ASSERT_LE(polished.cost, raw.cost);
  }
}

TEST(PolishTest, RepairsEndsPlacesAndObstacles) {
  const TerrainMap map = MapFromAscii({
      "1111111",
      "11###11",
      "9999999",
      "9999999",
      "9999999",
      "9999999",
  });
  const Route baseline = {{0, 1}, {0, 3}, {6, 3}, {6, 1}};
  const RefineInput input{map, baseline, WalkRoute(map, baseline).cost};
  // No ends, through the obstacle, above the map: the place is right.
  const RefineOutput polished = Polish(input, {{3, 1}, {4, -3}}, 1);
  EXPECT_DOUBLE_EQ(polished.cost, 4 + 2 * std::sqrt(2.0));
  // Without any proposal the place below remains, 9 a cell.
  EXPECT_GT(Polish(input, {{0, 1}, {0, 3}, {6, 3}, {6, 1}}, 0).cost, 9 * 6);
}

TEST(PolishTest, AProposalWithoutRoomAroundItKeepsItsCost) {
  const TerrainMap map = MapFromAscii({"1111", "1111", "1111"});
  const Route baseline = {{0, 0}, {0, 2}, {3, 2}};
  const RefineOutput polished = Polish({map, baseline, 5}, {{0, 0}, {3, 2}}, 0);
  EXPECT_DOUBLE_EQ(polished.cost, 1 + 2 * std::sqrt(2.0));
}

}  // namespace
}  // namespace terra::advisor

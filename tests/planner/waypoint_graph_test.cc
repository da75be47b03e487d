#include "planner/waypoint_graph.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "planner/coarse_lattice.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra::planner {
namespace {

using testing::MapFromAscii;
using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;
using testing::RandomPassableCell;

// The lattice as a graph; nodes in the same row-major order.
WaypointGraph LatticeGraph(const TerrainMap& map, int stride) {
  const int cols = (map.width() - 1) / stride + 1;
  const int rows = (map.height() - 1) / stride + 1;
  std::vector<WaypointGraph::Node> nodes;
  std::vector<WaypointGraph::Edge> edges;
  const auto index = [cols](int i, int j) {
    return static_cast<std::size_t>(j * cols + i);
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < cols; ++i) {
      nodes.push_back({std::to_string(nodes.size()), {i * stride, j * stride}});
      if (i > 0) edges.emplace_back(index(i, j), index(i - 1, j));
      if (j > 0) edges.emplace_back(index(i, j), index(i, j - 1));
      if (i > 0 && j > 0) edges.emplace_back(index(i, j), index(i - 1, j - 1));
      if (i + 1 < cols && j > 0) {
        edges.emplace_back(index(i, j), index(i + 1, j - 1));
      }
    }
  }
  return WaypointGraph(std::move(nodes), edges);
}

// The same graph with its nodes and edges in another order.
WaypointGraph Reversed(const WaypointGraph& graph) {
  std::vector<WaypointGraph::Node> nodes(graph.nodes().rbegin(),
                                         graph.nodes().rend());
  std::vector<WaypointGraph::Edge> edges;
  const std::size_t last = nodes.size() - 1;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (const std::size_t b : graph.Neighbours(a)) {
      if (a < b) edges.emplace_back(last - b, last - a);
    }
  }
  return WaypointGraph(std::move(nodes), edges);
}

// Cell for cell, by the lattice's tie rule, whatever the order of the nodes.
TEST(WaypointGraphTest, OfALatticeIsTheRouteOfTheLatticePlanner) {
  Random random(1);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const CostModel model{.corner_cutting = !random.OneIn(3),
                          .clearance_cells = random.OneIn(4) ? 1 : 0};
    const TerrainMap map =
        RandomMap(random, random.Int(1, 70), random.Int(1, 70),
                  static_cast<RandomMapKind>(random.Int(0, 2)), model);
    if ((map.classes() == 0).all()) continue;
    const Cell start = RandomPassableCell(random, map);
    const Cell goal = RandomPassableCell(random, map);
    const int stride = random.Int(1, 20);
    const LatticePlan want =
        PlanOnLattice(map, start, goal, {.stride = stride});
    const WaypointGraph graph = LatticeGraph(map, stride);
    const LatticePlan got = PlanOnGraph(map, graph, start, goal, 2 * stride);
    const LatticePlan reversed =
        PlanOnGraph(map, Reversed(graph), start, goal, 2 * stride);
    ASSERT_EQ(got.status, want.status) << "map " << i;
    if (!got.found()) continue;
    ++found;
    ASSERT_NEAR(got.cost, want.cost, 1e-9 * want.cost) << "map " << i;
    if (start != goal) {
      ASSERT_EQ(got.waypoints, want.waypoints) << "map " << i;
    }
    ASSERT_EQ(reversed.waypoints, got.waypoints) << "map " << i;
    ASSERT_EQ(WalkRoute(map, got.waypoints).cost, got.cost) << "map " << i;
    ASSERT_EQ(got.waypoints.front(), start);
    ASSERT_EQ(got.waypoints.back(), goal);
  }
  EXPECT_GT(found, 100);
}

// a -- b -- c along the top, a -- d -- c along the bottom.
WaypointGraph Loop() {
  return WaypointGraph(
      {{"a", {1, 2}}, {"b", {4, 0}}, {"c", {7, 2}}, {"d", {4, 4}}},
      {{0, 1}, {1, 2}, {0, 3}, {3, 2}});
}

TEST(WaypointGraphTest, TakesTheCheaperWayRound) {
  const TerrainMap map = MapFromAscii({
      "111919111",
      "119999911",
      "111###111",
      "111111111",
      "111111111",
  });
  const LatticePlan plan = PlanOnGraph(map, Loop(), {0, 2}, {8, 2}, 1);
  EXPECT_EQ(FormatRoute(plan.waypoints),
            "[(0, 2), (1, 2), (4, 4), (7, 2), (8, 2)]");
  EXPECT_EQ(plan.cost, WalkRoute(map, plan.waypoints).cost);
}

TEST(WaypointGraphTest, AnEndOnANodeIsOneWaypointWithIt) {
  const TerrainMap map = MapFromAscii({
      "111111111",
      "111111111",
      "111###111",
      "111###111",
      "111###111",
  });
  EXPECT_EQ(FormatRoute(PlanOnGraph(map, Loop(), {1, 2}, {7, 2}, 0).waypoints),
            "[(1, 2), (4, 0), (7, 2)]");
}

TEST(WaypointGraphTest, StartAndGoalReachTheGraphWithinTheReachOnly) {
  const TerrainMap map = MapFromAscii({
      "111111111",
      "111111111",
      "111###111",
      "111###111",
      "111###111",
  });
  EXPECT_TRUE(PlanOnGraph(map, Loop(), {0, 4}, {8, 4}, 2).found());
  EXPECT_EQ(PlanOnGraph(map, Loop(), {0, 4}, {8, 4}, 1).status,
            SearchStatus::kNoRoute);
  // Near each other they need no graph.
  EXPECT_EQ(FormatRoute(PlanOnGraph(map, Loop(), {0, 4}, {1, 4}, 1).waypoints),
            "[(0, 4), (1, 4)]");
}

TEST(WaypointGraphTest, EdgesThatTheMapDoesNotAllowDoNotExist) {
  // Node d is outside this map, node b on an obstacle.
  const TerrainMap map = MapFromAscii({
      "1111#1111",
      "111111111",
      "111111111",
  });
  EXPECT_EQ(PlanOnGraph(map, Loop(), {1, 2}, {7, 2}, 1).status,
            SearchStatus::kNoRoute);
}

TEST(WaypointGraphTest, SaysWhichEndIsWrong) {
  const TerrainMap map = MapFromAscii({"11#"});
  const auto status = [&](Cell start, Cell goal) {
    return PlanOnGraph(map, Loop(), start, goal, 1).status;
  };
  EXPECT_EQ(status({0, 1}, {0, 0}), SearchStatus::kStartOutside);
  EXPECT_EQ(status({0, 0}, {3, 0}), SearchStatus::kGoalOutside);
  EXPECT_EQ(status({2, 0}, {0, 0}), SearchStatus::kStartBlocked);
  EXPECT_EQ(status({0, 0}, {2, 0}), SearchStatus::kGoalBlocked);
  EXPECT_EQ(FormatRoute(PlanOnGraph(map, Loop(), {1, 0}, {1, 0}, 1).waypoints),
            "[(1, 0), (1, 0)]");
}

TEST(WaypointGraphTest, EdgesToNowhereAreABug) {
  EXPECT_THROW(WaypointGraph({{"a", {0, 0}}}, {{0, 1}}), std::logic_error);
  EXPECT_THROW(WaypointGraph({{"a", {0, 0}}}, {{0, 0}}), std::logic_error);
}

}  // namespace
}  // namespace terra::planner

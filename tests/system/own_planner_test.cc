// A planner of one's own in the place of terra-planner: the worked example of
// docs/own-planner.md, as real processes.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "planner/graph_file.h"
#include "planner/waypoint_graph.h"
#include "terrain/files/map_file.h"
#include "terrain/route_cost.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using terra_msg::baseline_t;
using terra_msg::deployed_t;
using testing::Robot;

constexpr Cell kStart = {30, 250};
constexpr Cell kGoal = {470, 250};
const std::string kGraph = TERRA_EXAMPLES "/graph";

TerrainMap ExampleMap() {
  return std::move(ReadMap(TERRA_EXAMPLES "/demo.png").value().map);
}

TEST(OwnPlanner, TheGateDeploysTheBaselineOfAWaypointGraph) {
  const TerrainMap map = ExampleMap();
  const planner::LatticePlan want = planner::PlanOnGraph(
      map, planner::ReadWaypointGraph(kGraph).value(), kStart, kGoal);
  ASSERT_TRUE(want.found());
  Robot robot(map);
  robot.Start("map");
  robot.Start("graph-planner", {"--graph", kGraph});
  robot.Start("verifier");
  const auto deployed = robot.Ask(21, kStart, kGoal);
  ASSERT_TRUE(deployed);
  EXPECT_EQ(deployed->mode, deployed_t::MODE_BASELINE);
  EXPECT_EQ(bus::WaypointsOf(*deployed), want.waypoints);
  EXPECT_NEAR(deployed->deployed_cost, want.cost, 1e-9);
  const auto baseline =
      robot.deployed_bus().WaitFor<baseline_t>([](const baseline_t& message) {
        return message.request_id == 21;
      });
  ASSERT_TRUE(baseline);
  EXPECT_EQ(baseline->planner, "graph-planner");

  robot.Start("advisor");
  const auto refined = robot.WaitForDeployed(21, deployed_t::MODE_CANDIDATE);
  ASSERT_TRUE(refined) << "advisors refine whatever the planner was";
  EXPECT_LT(refined->deployed_cost, want.cost - 1);
}

TEST(OwnPlanner, TakesOverWhileTheRequestStands) {
  Robot robot(ExampleMap());
  robot.Start("map");
  robot.Start("planner");
  robot.Start("verifier");
  const auto first = robot.Ask(22, kStart, kGoal);
  ASSERT_TRUE(first);
  robot.Kill("planner");
  robot.deployed_bus().Forget();
  robot.Start("graph-planner", {"--graph", kGraph});
  // The request is known from DEPLOYED alone; its sender is long gone.
  const auto baseline =
      robot.deployed_bus().WaitFor<baseline_t>([](const baseline_t& message) {
        return message.request_id == 22 && message.planner == "graph-planner" &&
               message.status == baseline_t::STATUS_OK;
      });
  ASSERT_TRUE(baseline);
}

TEST(OwnPlanner, ABadGraphEndsTheProcessWithFileAndLine) {
  const testing::TempFolder folder;
  folder.Write("nodes.csv", "name,x,y\na,1,1\nb,2,2\n");
  const std::string path = folder.Write("edges.csv", "from,to\na,c\n");
  Robot robot(ExampleMap());
  testing::ChildProcess& planner = robot.Start(
      "graph-planner", {"--graph", path.substr(0, path.rfind('/'))});
  EXPECT_EQ(planner.WaitForExit(testing::BusPeer::kPatience), 1);
  EXPECT_NE(planner.output().find("edges.csv:2: there is no node 'c'"),
            std::string::npos)
      << planner.output();
}

}  // namespace
}  // namespace terra

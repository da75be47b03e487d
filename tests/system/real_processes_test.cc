// The set as a robot runs it: real processes on a bus of their own, killed,
// stopped, flooded and lied to. Exact times are tested in virtual time
// (deployed_path_test.cc); here each thing must happen at all.
#include <signal.h>

#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/random_map.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using std::chrono::milliseconds;
using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::status_t;
using terra_msg::verdict_t;
using testing::Robot;

constexpr Cell kStart = {5, 60};
constexpr Cell kGoal = {155, 60};

// Ground with a costly bar between start and goal, open at the top.
TerrainMap BarMap(int bar_id = 10) {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(static_cast<std::uint8_t>(bar_id));
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

void StartDeployedPath(Robot& robot) {
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
}

TEST(RealProcesses, VerifiedCheaperRouteComesOutEndToEnd) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor");
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  const auto deployed = robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE);
  ASSERT_TRUE(deployed);
  const RouteWalk walk = WalkRoute(BarMap(), bus::WaypointsOf(*deployed));
  ASSERT_TRUE(walk.feasible());
  EXPECT_NEAR(walk.cost, deployed->deployed_cost, 1e-9);
  EXPECT_LT(deployed->deployed_cost, deployed->baseline_cost);
  EXPECT_EQ(deployed->source, "advisor");
  const auto verdict =
      robot.deployed_bus().WaitFor<verdict_t>([](const verdict_t& message) {
        return message.code == verdict_t::CODE_ACCEPTED;
      });
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->request_id, 11);
}

TEST(RealProcesses, BaselineIsDeployedWithoutAnyAdvisor) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  const auto deployed = robot.Ask(11, kStart, kGoal);
  ASSERT_TRUE(deployed);
  EXPECT_EQ(deployed->mode, deployed_t::MODE_BASELINE);
}

TEST(RealProcesses, BaselineIsDeployedWithAStoppedAdvisor) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor").Signal(SIGSTOP);
  const auto deployed = robot.Ask(11, kStart, kGoal);
  ASSERT_TRUE(deployed);
  EXPECT_EQ(deployed->mode, deployed_t::MODE_BASELINE);
  robot.process("advisor").Signal(SIGCONT);
  EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE))
      << "its advice is still fresh when it wakes";
}

TEST(RealProcesses, SeveralAdvisorsUnderTheirOwnNamesServeOneRequest) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("direct-search", {"--backend", "search"});
  robot.Start("cutter", {"--backend", "shortcut"});
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  for (const char* name : {"direct-search", "cutter"}) {
    EXPECT_TRUE(robot.deployed_bus().WaitFor<verdict_t>(
        [name](const verdict_t& verdict) {
          return verdict.advisor == name && verdict.request_id == 11;
        }))
        << name;
  }
}

TEST(RealProcesses, EachProcessKilledAfterTheRequesterWentIsBackInService) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor");
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  ASSERT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE));
  for (const std::string name : {"map", "planner", "verifier", "advisor"}) {
    robot.Kill(name);
    robot.deployed_bus().Forget();
    robot.Start(name, name == "planner"
                          ? std::vector<std::string>{"--stride", "20"}
                          : std::vector<std::string>{});
    EXPECT_TRUE(robot.WaitForReady(name)) << name;
    EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE))
        << "after " << name << " was killed";
  }
}

TEST(RealProcesses, NoStartUpOrderIsNeeded) {
  Robot robot(BarMap());
  for (const std::string name : {"verifier", "advisor", "planner", "map"}) {
    robot.Start(name);
    ASSERT_TRUE(
        robot.BusOf(name).WaitFor<status_t>([&](const status_t& status) {
          return status.status_name == name;
        }));
  }
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE));
}

TEST(RealProcesses, LargeMapReachesEveryProcessAtDefaultKernelLimits) {
  // Noise does not compress, so this is the hardest map of its size.
  testing::Random random(5);
  ByteRaster ids(4000, 4000);
  for (std::uint8_t& id : ids.reshaped()) {
    id = static_cast<std::uint8_t>(random.Int(0, 9));
  }
  const TerrainMap map =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  Robot robot(map);
  StartDeployedPath(robot);
  robot.Start("advisor");
  for (const char* name : {"planner", "verifier", "advisor"}) {
    EXPECT_TRUE(robot.WaitForReady(name, std::chrono::seconds(60))) << name;
  }
  const auto deployed = robot.Ask(11, {10, 10}, {3900, 3900});
  ASSERT_TRUE(deployed);
  EXPECT_EQ(deployed->map_id, MapId(map));
}

TEST(RealProcesses, FloodOnTheAdviceBusLeavesTheBaselineInService) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  std::atomic<bool> stop = false;
  std::thread flood([&] {
    advice_t advice{};
    advice.advisor = "babbler";
    while (!stop) robot.advice_bus().Send(advice);
  });
  for (std::int64_t request = 12; request < 32; ++request) {
    const auto deployed = robot.Ask(request, kStart, kGoal);
    EXPECT_TRUE(deployed && deployed->mode == deployed_t::MODE_BASELINE)
        << request;
  }
  stop = true;
  flood.join();
}

TEST(RealProcesses, HostileBytesOnBothBusesStopNobody) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor");
  ASSERT_TRUE(robot.WaitForReady("verifier"));
  ASSERT_TRUE(robot.WaitForReady("advisor"));
  testing::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> bytes(
        static_cast<std::size_t>(random.Int(0, 399)));
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(random.Int(0, 255));
    }
    const auto channel =
        static_cast<bus::Channel>(random.Int(0, bus::kNumChannels - 1));
    robot.deployed_bus().SendBytes(channel, bytes);
    robot.advice_bus().SendBytes(channel, bytes);
  }
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE));
  for (const char* name : {"map", "planner", "verifier", "advisor"}) {
    EXPECT_TRUE(robot.process(name).running()) << name;
  }
}

TEST(RealProcesses, LyingAdviceIsRefusedByName) {
  Robot robot(BarMap(11));  // The bar is an obstacle.
  StartDeployedPath(robot);
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  // Advice for a baseline that the gate has not heard of gets no verdict.
  const auto deployed =
      robot.deployed_bus().WaitFor<deployed_t>([](const deployed_t& message) {
        return message.mode == deployed_t::MODE_BASELINE;
      });
  ASSERT_TRUE(deployed);
  advice_t advice{};
  advice.request_id = 11;
  advice.map_id = deployed->map_id;
  advice.baseline_digest = deployed->baseline_digest;
  advice.anchor_x = kStart.x;
  advice.anchor_y = kStart.y;
  advice.advisor = "liar";
  advice.attempt = 1;
  advice.candidate = 1;
  advice.kind = advice_t::KIND_PROPOSE;
  bus::SetWaypoints(advice, {kStart, kGoal});
  robot.advice_bus().Send(advice);
  const auto verdict =
      robot.deployed_bus().WaitFor<verdict_t>([](const verdict_t& message) {
        return message.advisor == "liar";
      });
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->code, verdict_t::CODE_OBSTACLE);
  EXPECT_EQ(verdict->fail_x, 70);
}

TEST(RealProcesses, ChangedMapFileIsServedAndTheRouteFollowsIt) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  const TerrainMap blocked = BarMap(11);
  robot.SaveMap(blocked);
  const auto deployed = robot.deployed_bus().WaitFor<deployed_t>(
      [id = MapId(blocked)](const deployed_t& message) {
        return message.map_id == id &&
               message.mode == deployed_t::MODE_BASELINE;
      });
  ASSERT_TRUE(deployed);
  EXPECT_TRUE(WalkRoute(blocked, bus::WaypointsOf(*deployed)).feasible());
}

TEST(RealProcesses, EachEndsCleanlyWhenAsked) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor");
  for (const std::string name : {"map", "planner", "verifier", "advisor"}) {
    ASSERT_TRUE(
        robot.BusOf(name).WaitFor<status_t>([&](const status_t& status) {
          return status.status_name == name;
        }));
    EXPECT_EQ(robot.process(name).Terminate(), 0) << name;
  }
}

TEST(RealProcesses, RobotsWithAPrefixShareABusAndAMapServer) {
  Robot robot(BarMap());
  robot.Start("map");
  robot.Start("planner", {"--robot", "ALPHA", "--map-prefix", ""});
  robot.Start("verifier", {"--robot", "ALPHA", "--map-prefix", ""});
  testing::BusPeer alpha(robot.buses().url(), "ALPHA");
  terra_msg::plan_request_t request{};
  request.request_id = 5;
  request.action = terra_msg::plan_request_t::ACTION_GO;
  request.start_x = kStart.x;
  request.start_y = kStart.y;
  request.goal_x = kGoal.x;
  request.goal_y = kGoal.y;
  std::optional<deployed_t> deployed;
  for (int i = 0; i < 100 && !deployed; ++i) {
    alpha.Send(request);
    deployed = alpha.WaitFor<deployed_t>(
        [](const deployed_t& message) {
          return message.request_id == 5;
        },
        milliseconds(200));
  }
  ASSERT_TRUE(deployed);
  EXPECT_TRUE(robot.deployed_bus().Heard<deployed_t>().empty())
      << "nothing of it on the unprefixed channels";
}

TEST(RealProcesses, RequestToolPrintsWhatWasDeployed) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor");
  const std::string picture = robot.folder().Path("route.png");
  const auto request = testing::RunToEnd(
      {testing::ProgramPath("terra"), "request", "--lcm-url",
       robot.buses().url(), "--start", "5,60", "--goal", "155,60", "--map",
       robot.map_path(), "--picture", picture, "--json"});
  EXPECT_EQ(request.exit_code, 0) << request.output;
  EXPECT_NE(request.output.find("\"deployed\":\"candidate\""),
            std::string::npos)
      << request.output;
  EXPECT_EQ(testing::ReadBytes(picture).substr(1, 3), "PNG");
}

TEST(RealProcesses, MonitorShowsRouteVerdictsAndProcesses) {
  Robot robot(BarMap());
  StartDeployedPath(robot);
  robot.Start("advisor");
  testing::ChildProcess monitor({testing::ProgramPath("terra"), "monitor",
                                 "--lcm-url", robot.buses().url()});
  // It shows what it heard since its start, so the request waits for it.
  ASSERT_TRUE(monitor.WaitForOutput("planner", testing::BusPeer::kPatience));
  ASSERT_TRUE(robot.Ask(11, kStart, kGoal));
  for (const char* part : {"160 x 120", "candidate of advisor", "accepted",
                           "ready, candidate deployed"}) {
    EXPECT_TRUE(monitor.WaitForOutput(part, testing::BusPeer::kPatience))
        << part << " in\n"
        << monitor.output();
  }
  EXPECT_EQ(monitor.Terminate(), 0);
}

TEST(RealProcesses, RequestToolWithNobodyThereSaysWhatIsMissing) {
  const testing::TestBus buses;
  const auto request = testing::RunToEnd(
      {testing::ProgramPath("terra"), "request", "--lcm-url", buses.url(),
       "--start", "5,60", "--goal", "155,60", "--wait", "0.5"});
  EXPECT_EQ(request.exit_code, 1);
  EXPECT_NE(request.output.find("terra-planner"), std::string::npos)
      << request.output;
}

}  // namespace
}  // namespace terra

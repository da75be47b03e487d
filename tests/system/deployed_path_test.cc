// The deployed path as a set of nodes in virtual time: map server, planner and
// gate on one lossy bus, advice said by the test.
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "bus/map_node.h"
#include "planner/planner_node.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/files/map_file.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/virtual_network.h"
#include "verifier/verifier_node.h"

namespace terra {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::verdict_t;
using testing::VirtualNetwork;

constexpr Cell kStart = {5, 60};
constexpr Cell kGoal = {155, 60};
constexpr seconds kBackInService(2);

// Ground with a costly bar between start and goal, open at the top.
TerrainMap BarMap(int bar_id) {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(static_cast<std::uint8_t>(bar_id));
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

class DeployedPathTest : public ::testing::Test {
 protected:
  DeployedPathTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("terra_path_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    SaveMap(BarMap(10));
  }
  ~DeployedPathTest() override { std::filesystem::remove_all(folder_); }

  std::string map_path() const { return (folder_ / "map.png").string(); }
  void SaveMap(const TerrainMap& map) {
    ASSERT_TRUE(WriteIdPng(map, map_path()).ok());
    // File times are coarser than this test is fast.
    std::filesystem::last_write_time(
        map_path(),
        std::filesystem::last_write_time(map_path()) + seconds(++saves_));
  }

  void StartMap() {
    network_.Start("map", [this](bus::Outbox& out) {
      auto node =
          std::make_unique<bus::MapNode>(map_path(), MapFileOptions{}, out);
      EXPECT_TRUE(node->Load().ok());
      return node;
    });
  }
  void StartPlanner(const std::string& name = "planner") {
    network_.Start(name, [](bus::Outbox& out) {
      return std::make_unique<planner::PlannerNode>(
          "planner",
          [](const TerrainMap& map, Cell start, Cell goal) {
            return planner::PlanOnLattice(map, start, goal, {.stride = 20});
          },
          out);
    });
  }
  void StartGate() {
    network_.Start("gate", [](bus::Outbox& out) {
      auto node = std::make_unique<verifier::VerifierNode>(
          verifier::GateOptions{}, out);
      node->ListenToAdvice();
      return node;
    });
  }
  void StartAll() {
    StartMap();
    StartPlanner();
    StartGate();
  }

  // One message of a requester that then goes away.
  void Ask(std::int64_t request_id) {
    terra_msg::plan_request_t request{};
    request.session = 1;
    request.seq = ++requests_;
    request.request_id = request_id;
    request.action = terra_msg::plan_request_t::ACTION_GO;
    request.start_x = kStart.x;
    request.start_y = kStart.y;
    request.goal_x = kGoal.x;
    request.goal_y = kGoal.y;
    network_.Inject(request);
  }

  advice_t Proposal(const baseline_t& baseline, const Route& route,
                    std::int64_t attempt) {
    advice_t advice{};
    advice.session = 77;
    advice.seq = attempt;
    advice.request_id = baseline.request_id;
    advice.map_id = baseline.map_id;
    advice.baseline_digest = baseline.baseline_digest;
    advice.anchor_x = baseline.start_x;
    advice.anchor_y = baseline.start_y;
    advice.advisor = "test";
    advice.attempt = attempt;
    advice.candidate = 1;
    advice.kind = advice_t::KIND_PROPOSE;
    bus::SetWaypoints(advice, route);
    return advice;
  }
  void Advise(const baseline_t& baseline, const Route& route,
              std::int64_t attempt) {
    network_.Inject(Proposal(baseline, route, attempt));
  }

  // The robot follows what was deployed last.
  void DriveTo(Cell cell) {
    const deployed_t deployed = network_.Sent<deployed_t>().back();
    terra_msg::pose_t pose{};
    pose.session = 5;
    pose.seq = ++poses_;
    pose.pose_x = cell.x;
    pose.pose_y = cell.y;
    pose.deployed_session = deployed.session;
    pose.deployed_route_seq = deployed.route_seq;
    network_.Inject(pose);
    network_.Run(milliseconds(50));
  }

  template <typename T>
  bool HasLast(std::function<bool(const T&)> holds) const {
    const std::vector<T> sent = network_.Sent<T>();
    return !sent.empty() && holds(sent.back());
  }
  bool Deployed(std::int64_t request_id, std::int8_t mode) const {
    return HasLast<deployed_t>([=](const deployed_t& deployed) {
      return deployed.request_id == request_id && deployed.mode == mode;
    });
  }
  bool BaselineDeployed(std::int64_t request_id) {
    return network_.RunUntil(
        [=, this] {
          return Deployed(request_id, deployed_t::MODE_BASELINE);
        },
        kBackInService);
  }
  baseline_t LastBaseline() const { return network_.Sent<baseline_t>().back(); }

  int saves_ = 0;
  VirtualNetwork network_{7};
  std::filesystem::path folder_;
  std::int64_t requests_ = 0;
  std::int64_t poses_ = 0;
};

// Around the bar, above it.
const Route kAround = {kStart, {69, 29}, {91, 29}, kGoal};

TEST_F(DeployedPathTest, BaselineIsDeployedAndACheaperRouteReplacesIt) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  const baseline_t baseline = LastBaseline();
  ASSERT_LT(WalkRoute(BarMap(10), kAround).cost, baseline.baseline_cost);
  Advise(baseline, kAround, 1);
  ASSERT_TRUE(network_.RunUntil(
      [this] {
        return Deployed(11, deployed_t::MODE_CANDIDATE);
      },
      milliseconds(50)));
  const deployed_t deployed = network_.Sent<deployed_t>().back();
  EXPECT_EQ(bus::WaypointsOf(deployed), kAround);
  EXPECT_NEAR(deployed.deployed_cost, WalkRoute(BarMap(10), kAround).cost,
              1e-9);
  const verdict_t verdict = network_.Sent<verdict_t>().back();
  EXPECT_EQ(verdict.code, verdict_t::CODE_ACCEPTED);
  const bus::Chain chain = {deployed.num_steps, deployed.chain};
  EXPECT_EQ(bus::DecodeChain(kStart, chain).value(), RasterizeRoute(kAround));
}

TEST_F(DeployedPathTest, RepeatedAdviceGetsOneVerdict) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  for (int i = 0; i < 5; ++i) Advise(LastBaseline(), kAround, 1);
  network_.Run(milliseconds(100));
  EXPECT_EQ(network_.Sent<verdict_t>().size(), 1u);
}

// What one lost datagram costs: the planner's patience, not its period.
TEST_F(DeployedPathTest, ALostBaselineIsSaidAgainAtOnce) {
  StartAll();
  network_.Run(seconds(2));
  for (int lost = 1; lost <= 3; ++lost) {
    network_.LoseNext(bus::Channel::kBaseline, lost);
    Ask(10 + lost);
    EXPECT_TRUE(network_.RunUntil(
        [=, this] {
          return Deployed(10 + lost, deployed_t::MODE_BASELINE);
        },
        milliseconds(10 * lost + 1)))
        << lost << " lost";
  }
}

TEST_F(DeployedPathTest, ALostDeployedIsSaidAgainAtOnce) {
  StartAll();
  network_.Run(seconds(2));
  // The answer to the request, without a route yet, and the route.
  network_.LoseNext(bus::Channel::kDeployed, 2);
  network_.ForgetSent();
  Ask(11);
  network_.Run(milliseconds(11));
  EXPECT_EQ(network_.Sent<deployed_t>().size(), 3u);
  EXPECT_TRUE(Deployed(11, deployed_t::MODE_BASELINE));
  network_.Run(milliseconds(90));
  EXPECT_EQ(network_.Sent<deployed_t>().size(), 3u) << "and no more";
}

TEST_F(DeployedPathTest, WithoutAGateABaselineIsRepeatedThriceThenAsUsual) {
  StartMap();
  StartPlanner();
  network_.Run(seconds(2));
  Ask(11);
  network_.Run(milliseconds(100));
  EXPECT_EQ(network_.Sent<baseline_t>().size(), 4u);
  network_.Run(milliseconds(1000));
  EXPECT_EQ(network_.Sent<baseline_t>().size(), 9u) << "five times a second";
}

TEST_F(DeployedPathTest, ABaselineThatIsAnsweredIsNotSaidAgainAtOnce) {
  StartAll();
  network_.Run(seconds(2));
  Ask(11);
  network_.Run(milliseconds(100));
  EXPECT_EQ(network_.Sent<baseline_t>().size(), 1u);
}

TEST_F(DeployedPathTest, AdviceThroughAnObstacleChangesNothing) {
  SaveMap(BarMap(11));
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  Advise(LastBaseline(), {kStart, kGoal}, 1);
  network_.Run(milliseconds(100));
  EXPECT_TRUE(Deployed(11, deployed_t::MODE_BASELINE));
  const verdict_t verdict = network_.Sent<verdict_t>().back();
  EXPECT_EQ(verdict.code, verdict_t::CODE_OBSTACLE);
  EXPECT_EQ(verdict.fail_x, 70);
  EXPECT_EQ(verdict.fail_y, 60);
}

TEST_F(DeployedPathTest, AdviceBehindTheRobotIsLate) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  DriveTo({kStart.x + 20, kStart.y});
  Advise(LastBaseline(), kAround, 1);
  network_.Run(milliseconds(50));
  EXPECT_EQ(network_.Sent<verdict_t>().back().code, verdict_t::CODE_LATE);
  EXPECT_TRUE(Deployed(11, deployed_t::MODE_BASELINE));
}

TEST_F(DeployedPathTest, AdviceFromAnAnchorAheadOfTheRobotKeepsTheWayThere) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  const deployed_t before = network_.Sent<deployed_t>().back();
  const CellPath cells =
      bus::DecodeChain(kStart, {before.num_steps, before.chain}).value();
  DriveTo(cells[10]);
  advice_t advice =
      Proposal(LastBaseline(), {cells[20], {69, 29}, {91, 29}, kGoal}, 1);
  advice.anchor_session = before.session;
  advice.anchor_route_seq = before.route_seq;
  advice.anchor_index = 20;
  advice.anchor_x = cells[20].x;
  advice.anchor_y = cells[20].y;
  network_.Inject(advice);
  network_.Run(milliseconds(50));
  ASSERT_TRUE(Deployed(11, deployed_t::MODE_CANDIDATE));
  const deployed_t after = network_.Sent<deployed_t>().back();
  CellPath expected(cells.begin(), cells.begin() + 20);
  const CellPath tail = RasterizeRoute(bus::WaypointsOf(advice));
  expected.insert(expected.end(), tail.begin(), tail.end());
  EXPECT_EQ(bus::DecodeChain(kStart, {after.num_steps, after.chain}).value(),
            expected);
}

TEST_F(DeployedPathTest, AnyOrderOfStartsEndsInService) {
  Ask(11);
  StartGate();
  network_.Run(seconds(3));
  StartPlanner();
  network_.Run(seconds(1));
  StartMap();
  Ask(12);
  EXPECT_TRUE(BaselineDeployed(12));
}

TEST_F(DeployedPathTest, GateKilledAMinuteAfterTheRequesterWentIsBack) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  network_.Run(seconds(60));
  network_.Kill("gate");
  network_.Run(seconds(1));
  network_.ForgetSent();
  StartGate();
  EXPECT_TRUE(BaselineDeployed(11));
}

TEST_F(DeployedPathTest, PlannerKilledAMinuteAfterTheRequesterWentIsBack) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  network_.Run(seconds(60));
  network_.Kill("planner");
  network_.Run(seconds(1));
  network_.ForgetSent();
  StartPlanner();
  EXPECT_TRUE(network_.RunUntil(
      [this] {
        return HasLast<baseline_t>([](const baseline_t& baseline) {
          return baseline.request_id == 11 &&
                 baseline.status == baseline_t::STATUS_OK;
        });
      },
      kBackInService));
}

TEST_F(DeployedPathTest, LosingEveryThirdMessageOnlyDelays) {
  network_.LoseOneIn(3);
  StartAll();
  network_.Run(seconds(5));
  for (std::int64_t id = 21; id < 31; ++id) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      Ask(id);
      network_.Run(milliseconds(200));
    }
    EXPECT_TRUE(BaselineDeployed(id)) << id;
  }
}

TEST_F(DeployedPathTest, BlockedRouteIsHeldUntilThePlannerFindsAnother) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  const std::int64_t old_map = LastBaseline().map_id;
  SaveMap(BarMap(11));
  ASSERT_TRUE(network_.RunUntil(
      [this, old_map] {
        return HasLast<deployed_t>([old_map](const deployed_t& deployed) {
          return deployed.map_id != old_map &&
                 deployed.mode == deployed_t::MODE_BASELINE;
        });
      },
      seconds(5)));
  const deployed_t deployed = network_.Sent<deployed_t>().back();
  EXPECT_TRUE(WalkRoute(BarMap(11), bus::WaypointsOf(deployed)).feasible());
}

TEST_F(DeployedPathTest, NewRequestReplacesTheOldOneForGood) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  Ask(12);
  ASSERT_TRUE(BaselineDeployed(12));
  Ask(11);
  network_.Run(seconds(1));
  EXPECT_TRUE(Deployed(12, deployed_t::MODE_BASELINE));
}

TEST_F(DeployedPathTest, SecondPlannerTakesOverAndTheFirstIsIgnored) {
  StartAll();
  Ask(11);
  ASSERT_TRUE(BaselineDeployed(11));
  StartPlanner("other planner");
  network_.Run(seconds(1));
  bus::Counters counters;
  verifier::VerifierNode* gate = nullptr;
  network_.Start("gate", [&gate](bus::Outbox& out) {
    auto node =
        std::make_unique<verifier::VerifierNode>(verifier::GateOptions{}, out);
    gate = node.get();
    return node;
  });
  network_.Run(seconds(2));
  gate->AddCounters(counters);
  std::int64_t from_replaced = 0;
  for (const auto& [name, value] : counters) {
    if (name == "from_replaced_planner") from_replaced = value;
  }
  EXPECT_GT(from_replaced, 0);
  EXPECT_TRUE(Deployed(11, deployed_t::MODE_BASELINE));
}

}  // namespace
}  // namespace terra

// An advisor that takes its time, beside a robot that does not wait for it: map
// server, planner, gate and advisor in virtual time.
#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "advisor/advisor_node.h"
#include "bus/codec.h"
#include "bus/map_node.h"
#include "planner/coarse_lattice.h"
#include "planner/planner_node.h"
#include "terrain/files/map_file.h"
#include "terrain/native_search.h"
#include "terrain/segment.h"
#include "tests/support/bar_map.h"
#include "tests/support/temp_folder.h"
#include "tests/support/virtual_network.h"
#include "verifier/verifier_node.h"

namespace terra {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using terra_msg::advice_t;
using terra_msg::deployed_t;
using terra_msg::verdict_t;
using testing::kBarGoal;
using testing::kBarStart;

constexpr double kUsualSeconds = 5;
constexpr seconds kPatience(20);

// What a test and the backend in the advisor's thread say to each other.
class Desk {
 public:
  // Of the backend: a task has come; returns whether it may be answered.
  bool Await(const advisor::AdviceTask& task, std::stop_token stop) {
    std::unique_lock lock(mutex_);
    starts_.push_back(task.start);
    baselines_.push_back(task.baseline);
    changed_.notify_all();
    return changed_.wait(lock, stop, [this] {
      return std::exchange(release_, false);
    });
  }
  void Answered() {
    const std::scoped_lock lock(mutex_);
    ++answers_;
    changed_.notify_all();
  }

  // Of the test.
  bool WaitForTasks(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] {
      return starts_.size() >= count;
    });
  }
  bool Answer() {
    std::unique_lock lock(mutex_);
    release_ = true;
    changed_.notify_all();
    const int before = answers_;
    return changed_.wait_for(lock, kPatience, [&] {
      return answers_ > before;
    });
  }
  Cell start(std::size_t i) {
    const std::scoped_lock lock(mutex_);
    return starts_.at(i);
  }
  Route baseline(std::size_t i) {
    const std::scoped_lock lock(mutex_);
    return baselines_.at(i);
  }
  std::size_t tasks() {
    const std::scoped_lock lock(mutex_);
    return starts_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<Cell> starts_;
  std::vector<Route> baselines_;
  bool release_ = false;
  int answers_ = 0;
};

// Finds the optimum, and says so when the test lets it.
class SlowBackend : public advisor::Backend {
 public:
  explicit SlowBackend(Desk& desk) : desk_(desk) {}
  std::string name() const override { return "slow"; }
  std::string method() const override { return "test"; }
  double usual_seconds() const override { return kUsualSeconds; }
  advisor::AdviceAnswer Advise(const advisor::AdviceTask& task,
                               std::stop_token stop) override {
    advisor::AdviceAnswer answer;
    if (!desk_.Await(task, stop)) return answer;
    answer.kind = advisor::AnswerKind::kPropose;
    answer.candidates.push_back(
        {CornersOf(NativeSearch(task.map, task.start, task.goal).cells),
         false});
    return answer;
  }

 private:
  Desk& desk_;
};

class MovingRobot : public ::testing::Test {
 protected:
  MovingRobot() {
    EXPECT_TRUE(WriteIdPng(testing::BarMap(), folder_.Path("map.png")).ok());
    network_.Start("map", [this](bus::Outbox& out) {
      auto node = std::make_unique<bus::MapNode>(folder_.Path("map.png"),
                                                 MapFileOptions{}, out);
      EXPECT_TRUE(node->Load().ok());
      return node;
    });
    network_.Start("planner", [](bus::Outbox& out) {
      return std::make_unique<planner::PlannerNode>(
          "planner",
          [](const TerrainMap& map, Cell start, Cell goal) {
            return planner::PlanOnLattice(map, start, goal, {.stride = 20});
          },
          out);
    });
    network_.Start("gate", [](bus::Outbox& out) {
      auto node = std::make_unique<verifier::VerifierNode>(
          verifier::GateOptions{}, out);
      node->ListenToAdvice();
      return node;
    });
    network_.Start("advisor", [this](bus::Outbox& out) {
      return std::make_unique<advisor::AdvisorNode>(
          "slow", std::make_unique<SlowBackend>(desk_), out, [this] {
            desk_.Answered();
          });
    });
    network_.Run(seconds(1));
  }

  void Ask() {
    terra_msg::plan_request_t request{};
    request.session = request.seq = 1;
    request.request_id = 11;
    request.action = terra_msg::plan_request_t::ACTION_GO;
    request.start_x = kBarStart.x;
    request.start_y = kBarStart.y;
    request.goal_x = kBarGoal.x;
    request.goal_y = kBarGoal.y;
    network_.Inject(request);
    network_.Run(seconds(1));
  }

  // The cells of the route in force, as the robot drives them.
  CellPath Cells() {
    return RasterizeRoute(bus::WaypointsOf(network_.Sent<deployed_t>().back()));
  }

  // Lets the backend answer. Nobody wakes a node in virtual time: the next
  // repeated message does.
  bool Answer() {
    const bool answered = desk_.Answer();
    network_.Run(milliseconds(500));
    return answered && !network_.Sent<verdict_t>().empty();
  }

  void Drive(int index, double cells_per_s) {
    const deployed_t deployed = network_.Sent<deployed_t>().back();
    const Cell cell = Cells().at(static_cast<std::size_t>(index));
    Say(cell, cells_per_s, deployed.session, deployed.route_seq);
  }
  void Say(Cell cell, double cells_per_s, std::int64_t session,
           std::int64_t route_seq) {
    terra_msg::pose_t pose{};
    pose.session = 5;
    pose.seq = ++poses_;
    pose.pose_x = cell.x;
    pose.pose_y = cell.y;
    pose.speed_mps = cells_per_s;  // A cell is a metre.
    pose.deployed_session = session;
    pose.deployed_route_seq = route_seq;
    network_.Inject(pose);
    network_.Run(milliseconds(10));
  }

  testing::TempFolder folder_;
  Desk desk_;
  std::int64_t poses_ = 0;
  testing::VirtualNetwork network_;  // last: its advisor uses the desk
};

TEST_F(MovingRobot, AProposalBeginsWhereItWillBeAndIsDeployed) {
  Say({80, 100}, 4, 0, 0);  // On its way on an earlier route.
  Ask();
  ASSERT_TRUE(desk_.WaitForTasks(1));
  const CellPath cells = Cells();
  constexpr int kAnchor = 4 * 5 + advisor::AnchorChooser::kMarginCells;
  EXPECT_EQ(desk_.start(0), cells[kAnchor]);
  EXPECT_EQ(RasterizeRoute(desk_.baseline(0)),
            CellPath(cells.begin() + kAnchor, cells.end()));

  for (int index = 0; index <= 4 * 5; ++index) Drive(index, 4);
  ASSERT_TRUE(Answer());
  const verdict_t verdict = network_.Sent<verdict_t>().back();
  EXPECT_EQ(int{verdict.code}, int{verdict_t::CODE_ACCEPTED});
  EXPECT_EQ(verdict.anchor_index, kAnchor);
  const CellPath joined = Cells();
  ASSERT_GT(joined.size(), std::size_t{kAnchor});
  EXPECT_TRUE(
      std::equal(cells.begin(), cells.begin() + kAnchor + 1, joined.begin()))
      << "the way to the anchor is the way that it drives";
}

TEST_F(MovingRobot, AProposalBeginsAtTheStartWhileItStandsThere) {
  Say(kBarStart, 0, 0, 0);
  Ask();
  ASSERT_TRUE(desk_.WaitForTasks(1));
  EXPECT_EQ(desk_.start(0), kBarStart);
  ASSERT_TRUE(Answer());
  EXPECT_EQ(int{network_.Sent<deployed_t>().back().mode},
            int{deployed_t::MODE_CANDIDATE});
}

TEST_F(MovingRobot, WorkBeginsAgainFurtherAheadWhenItPassedTheAnchor) {
  Ask();
  ASSERT_TRUE(desk_.WaitForTasks(1));
  EXPECT_EQ(desk_.start(0), kBarStart);
  Drive(6, 2);
  ASSERT_TRUE(desk_.WaitForTasks(2)) << "the call for the start is cancelled";
  const CellPath cells = Cells();
  EXPECT_EQ(desk_.start(1), cells[6 + 2 * 5 + 10]);
  Drive(7, 2);
  ASSERT_TRUE(Answer());
  EXPECT_EQ(desk_.tasks(), 2u);
  EXPECT_EQ(int{network_.Sent<verdict_t>().back().code},
            int{verdict_t::CODE_ACCEPTED});
  EXPECT_EQ(network_.Sent<advice_t>().back().anchor_index, 26);
}

TEST_F(MovingRobot, AdviceThatCameTooLateIsWorkedOutAgainOnce) {
  Ask();
  ASSERT_TRUE(desk_.WaitForTasks(1));
  ASSERT_TRUE(Answer());
  const advice_t advice = network_.Sent<advice_t>().back();
  verdict_t late{};
  late.subject = verdict_t::SUBJECT_ADVICE;
  late.code = verdict_t::CODE_LATE;
  late.advisor = advice.advisor;
  late.advisor_session = advice.session;
  late.attempt = advice.attempt;
  verdict_t of_another = late;
  of_another.advisor_session += 1;
  network_.Inject(of_another);
  network_.Run(seconds(3));
  EXPECT_EQ(desk_.tasks(), 1u);
  for (int i = 0; i < 5; ++i) network_.Inject(late);
  network_.Run(seconds(3));
  ASSERT_TRUE(desk_.WaitForTasks(2));
  network_.Run(seconds(3));
  EXPECT_EQ(desk_.tasks(), 2u);
}

}  // namespace
}  // namespace terra

#include "logger/audit.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "bus/map_node.h"
#include "logger/state_snapshot.h"
#include "planner/planner_node.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "terrain/segment.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"
#include "tests/support/virtual_network.h"
#include "verifier/verifier_node.h"

namespace terra::logger {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::plan_request_t;
using testing::TempFolder;
using testing::VirtualNetwork;

using Bytes = std::vector<std::uint8_t>;
using Messages = std::vector<bus::RawMessage>;

constexpr Cell kStart = {5, 60};
constexpr Cell kGoal = {155, 60};
// Through the open top of the bar.
const Route kOverTheTop = {kStart, {60, 20}, {100, 20}, kGoal};
const Route kHigherUp = {kStart, {60, 10}, {100, 10}, kGoal};
const Route kThroughTheBar = {kStart, kGoal};

TerrainMap BarMap(int bar_id, int hole_y = -1) {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(static_cast<std::uint8_t>(bar_id));
  if (hole_y >= 0) ids.block(hole_y, 70, 5, 20).setConstant(2);
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

// Plays a run of the deployed path in virtual time and keeps what was said.
class RecordedRun {
 public:
  RecordedRun() {
    SaveMap(BarMap(10));
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
    network_.Run(seconds(1));
  }

  void SaveMap(const TerrainMap& map) {
    const std::string path = folder_.Path("map.png");
    ASSERT_TRUE(WriteIdPng(map, path).ok());
    std::filesystem::last_write_time(
        path, std::filesystem::last_write_time(path) + seconds(++saves_));
  }
  void Ask(std::int64_t request_id, bool cancel = false) {
    plan_request_t request{};
    request.session = 1;
    request.seq = ++said_;
    request.request_id = request_id;
    request.action =
        cancel ? plan_request_t::ACTION_CANCEL : plan_request_t::ACTION_GO;
    request.start_x = kStart.x;
    request.start_y = kStart.y;
    request.goal_x = kGoal.x;
    request.goal_y = kGoal.y;
    Inject(request);
  }
  baseline_t Baseline() const { return network_.Sent<baseline_t>().back(); }
  void Advise(const baseline_t& baseline, std::int64_t attempt,
              const Route& route, std::int8_t kind = advice_t::KIND_PROPOSE) {
    advice_t advice{};
    advice.session = 77;
    advice.seq = ++said_;
    advice.request_id = baseline.request_id;
    advice.map_id = baseline.map_id;
    advice.baseline_digest = baseline.baseline_digest;
    advice.anchor_x = kStart.x;
    advice.anchor_y = kStart.y;
    advice.advisor = "test";
    advice.attempt = attempt;
    advice.kind = kind;
    bus::SetWaypoints(advice, route);
    Inject(advice);
  }
  template <typename T>
  void Inject(const T& message) {
    network_.Inject(message);
    network_.Run(milliseconds(300));
  }
  void Run(bus::Duration duration) { network_.Run(duration); }

  const Messages& messages() const { return network_.messages(); }

 private:
  TempFolder folder_;
  VirtualNetwork network_;
  int saves_ = 0;
  std::int64_t said_ = 0;
};

// Requests, advice of every kind, two map updates, a cancel.
Messages EventfulRun() {
  RecordedRun run;
  run.Ask(11);
  const baseline_t first = run.Baseline();
  run.Advise(first, 1, kOverTheTop);
  run.Advise(first, 2, kHigherUp);  // not best
  run.Advise(first, 3, kThroughTheBar);
  run.Advise(first, 4, {}, advice_t::KIND_RETAIN);
  run.Advise(first, 5, {kStart, {400, 3}, kGoal});
  run.Advise(first, 6, {}, advice_t::KIND_MALFORMED);
  run.SaveMap(BarMap(10, 60));  // a way through the bar
  run.Run(seconds(3));
  run.Advise(first, 7, kOverTheTop);  // stale map
  run.Advise(run.Baseline(), 8, kThroughTheBar);
  run.Ask(12);
  run.Advise(first, 9, kOverTheTop);  // stale request
  run.Advise(run.Baseline(), 10, kThroughTheBar);
  run.SaveMap(BarMap(11));
  run.Run(seconds(3));
  run.Ask(12, true);
  return run.messages();
}

Bytes LogOf(const Messages& messages) {
  Bytes bytes;
  std::int64_t number = 0;
  for (const bus::RawMessage& message : messages) {
    AppendLogEvent(bytes, {number, 1'000 * number,
                           bus::BaseName(message.channel), message.bytes});
    ++number;
  }
  return bytes;
}

Audit AuditOf(const Messages& messages) {
  const Bytes bytes = LogOf(messages);
  LogReader reader(bytes);
  return AuditLog(reader);
}

std::string Text(const Audit& audit) {
  std::string text;
  for (const Finding& finding : audit.findings) {
    text += std::string(KindName(finding.kind)) + " at decision " +
            std::to_string(finding.decision) + ": " + finding.what + "\n";
  }
  return text;
}

template <typename T>
std::vector<T> Said(const Messages& messages) {
  std::vector<T> said;
  for (const bus::RawMessage& message : messages) {
    if (message.channel != bus::MessageTraits<T>::kChannel) continue;
    said.push_back(bus::Decode<T>(message.bytes).value());
  }
  return said;
}

TEST(Audit, EveryDecisionOfAnHonestLogIsMadeAgain) {
  const Messages messages = EventfulRun();
  const Audit audit = AuditOf(messages);
  EXPECT_TRUE(audit.clean()) << Text(audit);
  EXPECT_EQ(audit.sessions, 1);
  EXPECT_EQ(audit.anchors, 0);
  const auto verdicts = Said<terra_msg::verdict_t>(messages);
  EXPECT_EQ(audit.verdicts, std::ssize(verdicts));
  EXPECT_GE(audit.verdicts, 10);
  std::int64_t last_decision = 0;
  for (const deployed_t& deployed : Said<deployed_t>(messages)) {
    last_decision = std::max(last_decision, deployed.decision);
  }
  EXPECT_EQ(audit.verdicts + audit.deployed, last_decision);
}

TEST(Audit, TheOrderOfTheLogDoesNotMatter) {
  Messages messages = EventfulRun();
  // Advice is heard by another socket, so it may be logged after its verdict.
  std::stable_partition(messages.begin(), messages.end(),
                        [](const bus::RawMessage& message) {
                          return message.channel == bus::Channel::kVerdict ||
                                 message.channel == bus::Channel::kDeployed;
                        });
  const Audit audit = AuditOf(messages);
  EXPECT_TRUE(audit.clean()) << Text(audit);
}

TEST(Audit, AMissingInputIsNamed) {
  Messages messages = EventfulRun();
  std::erase_if(messages, [](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kAdvice &&
           bus::Decode<advice_t>(message.bytes)->attempt == 3;
  });
  const Audit audit = AuditOf(messages);
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMissingInput);
  EXPECT_NE(audit.findings[0].what.find("attempt 3"), std::string::npos);
}

TEST(Audit, AForgedVerdictIsAMismatch) {
  Messages messages = EventfulRun();
  for (bus::RawMessage& message : messages) {
    if (message.channel != bus::Channel::kVerdict) continue;
    auto verdict = *bus::Decode<terra_msg::verdict_t>(message.bytes);
    verdict.candidate_cost = 1.0;
    message.bytes = bus::Encode(verdict);
    break;
  }
  const Audit audit = AuditOf(messages);
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kMismatch);
}

TEST(Audit, AMissingDecisionIsAGap) {
  Messages messages = EventfulRun();
  std::erase_if(messages, [](const bus::RawMessage& message) {
    return message.channel == bus::Channel::kVerdict &&
           bus::Decode<terra_msg::verdict_t>(message.bytes)->attempt == 4;
  });
  const Audit audit = AuditOf(messages);
  ASSERT_FALSE(audit.clean());
  EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kGap);
}

}  // namespace
}  // namespace terra::logger

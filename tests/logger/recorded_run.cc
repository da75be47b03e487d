#include "tests/logger/recorded_run.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "bus/map_node.h"
#include "logger/recorder.h"
#include "planner/planner_node.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "terrain/segment.h"
#include "verifier/verifier_node.h"

namespace terra::logger {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::plan_request_t;

// Through the open top of the bar.
const Route kOverTheTop = {
    RecordedRun::kStart, {69, 29}, {90, 29}, RecordedRun::kGoal};
const Route kHigherUp = {
    RecordedRun::kStart, {69, 28}, {90, 28}, RecordedRun::kGoal};
const Route kThroughTheBar = {RecordedRun::kStart, RecordedRun::kGoal};
// From one message of a log to the next; for so long the recorder heard others
// after them.
constexpr std::int64_t kBetweenUs = 1'000;
constexpr std::int64_t kOthersUs = 5'000'000;

const Route kOutside = {RecordedRun::kStart, {400, 3}, RecordedRun::kGoal};

}  // namespace

RecordedRun::RecordedRun(double margin) : margin_(margin) {
  SaveMap(BarMap(10));
  StartMap();
  StartPlanner();
  StartGate();
  Run(seconds(1));
}

void RecordedRun::StartMap() {
  network_.Start("map", [this](bus::Outbox& out) {
    auto node = std::make_unique<bus::MapNode>(folder_.Path("map.png"),
                                               MapFileOptions{}, out);
    EXPECT_TRUE(node->Load().ok());
    return node;
  });
}

void RecordedRun::StartPlanner() {
  network_.Start("planner", [](bus::Outbox& out) {
    return std::make_unique<planner::PlannerNode>(
        "planner",
        [](const TerrainMap& map, Cell start, Cell goal) {
          return planner::PlanOnLattice(map, start, goal, {.stride = 20});
        },
        out);
  });
}

void RecordedRun::StartGate() {
  network_.Start("gate", [this](bus::Outbox& out) {
    terra_msg::config_t config{};
    config.config_name = "verifier";
    config.config_text =
        "name=\"verifier\"\nmargin=" + std::to_string(margin_) + "\n";
    out.Send(config);
    auto node = std::make_unique<verifier::VerifierNode>(
        verifier::GateOptions{.margin = margin_}, out);
    node->ListenToAdvice();
    return node;
  });
}

TerrainMap RecordedRun::BarMap(int bar_id, int hole_y) {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(static_cast<std::uint8_t>(bar_id));
  if (hole_y >= 0) ids.block(hole_y, 70, 5, 20).setConstant(2);
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

void RecordedRun::SaveMap(const TerrainMap& map) {
  const std::string path = folder_.Path("map.png");
  ASSERT_TRUE(WriteIdPng(map, path).ok());
  std::filesystem::last_write_time(
      path, std::filesystem::last_write_time(path) + seconds(++saves_));
}

void RecordedRun::Ask(std::int64_t request_id, bool cancel) {
  plan_request_t request{};
  request.session = 1;
  request.request_id = request_id;
  request.action =
      cancel ? plan_request_t::ACTION_CANCEL : plan_request_t::ACTION_GO;
  request.start_x = kStart.x;
  request.start_y = kStart.y;
  request.goal_x = kGoal.x;
  request.goal_y = kGoal.y;
  Inject(request);
}

advice_t RecordedRun::AdviceFor(const baseline_t& baseline,
                                const Route& route) {
  advice_t advice{};
  advice.session = 77;
  advice.request_id = baseline.request_id;
  advice.map_id = baseline.map_id;
  advice.baseline_digest = baseline.baseline_digest;
  advice.anchor_x = kStart.x;
  advice.anchor_y = kStart.y;
  advice.advisor = "test";
  advice.attempt = ++said_;
  bus::SetWaypoints(advice, route);
  return advice;
}

void RecordedRun::Advise(const baseline_t& baseline, const Route& route,
                         std::int8_t kind) {
  advice_t advice = AdviceFor(baseline, route);
  advice.kind = kind;
  Inject(advice);
}

void RecordedRun::AdviseFrom(const deployed_t& deployed, int index) {
  const CellPath cells = RasterizeRoute(bus::WaypointsOf(deployed));
  if (index >= std::ssize(cells)) return;
  const Cell anchor = cells[static_cast<std::size_t>(index)];
  baseline_t baseline{};
  baseline.request_id = deployed.request_id;
  baseline.map_id = deployed.map_id;
  baseline.baseline_digest = deployed.baseline_digest;
  advice_t advice = AdviceFor(baseline, {anchor, kGoal});
  advice.kind = advice_t::KIND_PROPOSE;
  advice.anchor_session = deployed.session;
  advice.anchor_route_seq = deployed.route_seq;
  advice.anchor_index = index;
  advice.anchor_x = anchor.x;
  advice.anchor_y = anchor.y;
  Inject(advice);
}

void RecordedRun::DriveTo(const deployed_t& deployed, int index) {
  const CellPath cells = RasterizeRoute(bus::WaypointsOf(deployed));
  if (index >= std::ssize(cells)) return;
  terra_msg::pose_t pose{};
  pose.session = 2;
  pose.pose_x = cells[static_cast<std::size_t>(index)].x;
  pose.pose_y = cells[static_cast<std::size_t>(index)].y;
  pose.deployed_session = deployed.session;
  pose.deployed_route_seq = deployed.route_seq;
  Inject(pose);
}

std::optional<baseline_t> RecordedRun::Baseline() const {
  const auto said = network_.Sent<baseline_t>();
  return said.empty() ? std::nullopt : std::optional(said.back());
}

std::optional<deployed_t> RecordedRun::Deployed() const {
  const auto said = network_.Sent<deployed_t>();
  return said.empty() ? std::nullopt : std::optional(said.back());
}

Messages EventfulRun() {
  RecordedRun run;
  run.Ask(11);
  const baseline_t first = *run.Baseline();
  run.Advise(first, kOverTheTop);
  run.Advise(first, kHigherUp);  // not best
  run.Advise(first, kThroughTheBar);
  run.Advise(first, {}, advice_t::KIND_RETAIN);
  run.Advise(first, kOutside);
  run.Advise(first, {}, advice_t::KIND_MALFORMED);
  run.Advise(first, {}, 99);
  run.Advise(first, {}, advice_t::KIND_FAILED);  // gets no verdict
  const deployed_t driven = *run.Deployed();
  run.DriveTo(driven, 30);
  run.AdviseFrom(driven, 10);                // late
  run.AdviseFrom(driven, 90);                // better from there on
  run.SaveMap(RecordedRun::BarMap(10, 60));  // a way through the bar
  run.Run(seconds(3));
  run.Advise(first, kOverTheTop);  // stale map
  run.Advise(*run.Baseline(), kThroughTheBar);
  run.Ask(12);
  run.Advise(first, kOverTheTop);  // stale request
  run.Advise(*run.Baseline(), kThroughTheBar);
  run.StartGate();
  run.Run(seconds(3));
  run.SaveMap(RecordedRun::BarMap(11));
  run.Run(seconds(3));
  run.Ask(12, true);
  return run.messages();
}

Messages RandomRun(std::uint64_t seed) {
  testing::Random random(seed);
  RecordedRun run(random.OneIn(3) ? 2.0 : 0.0);
  std::int64_t request = 100;
  int place = 0;
  std::vector<baseline_t> baselines;
  const std::array routes = {kOverTheTop, kHigherUp, kThroughTheBar, kOutside};
  for (int step = 0; step < 30; ++step) {
    const auto baseline = run.Baseline();
    const auto deployed = run.Deployed();
    if (baseline) baselines.push_back(*baseline);
    const int what = random.Int(0, 17);
    if (what == 0 || request == 100) {
      run.Ask(++request);
      place = 0;
    } else if (what == 1) {
      run.Ask(request, true);
    } else if (what == 2) {
      // 9 and 255 cannot be crossed; the hole may be no way through.
      run.SaveMap(
          RecordedRun::BarMap(random.Int(7, 11), random.OneIn(2) ? -1 : 60));
      run.Run(milliseconds(random.Int(1, 2'500)));
    } else if (what == 3) {
      run.StartGate();
    } else if (what == 4) {
      run.StartPlanner();
    } else if (what == 5) {
      run.Ask(random.Int(90, 200), true);  // perhaps of none
    } else if (what <= 8 && deployed) {
      // A robot does not turn back.
      place = random.Int(place, 150);
      run.DriveTo(*deployed, place);
    } else if (what <= 11 && deployed) {
      run.AdviseFrom(*deployed, random.Int(0, 150));
    } else if (!baselines.empty()) {
      const auto age = static_cast<std::size_t>(
          random.Int(0, std::min(4, static_cast<int>(baselines.size()) - 1)));
      run.Advise(
          baselines[baselines.size() - 1 - age],
          routes[static_cast<std::size_t>(random.Int(0, 3))],
          static_cast<std::int8_t>(random.OneIn(2) ? int{advice_t::KIND_PROPOSE}
                                                   : random.Int(1, 5)));
    }
    if (random.OneIn(3)) run.Run(milliseconds(random.Int(1, 1'500)));
  }
  return run.messages();
}

std::int64_t DecisionsIn(const Messages& messages) {
  std::map<std::int64_t, std::int64_t> last;
  for (const terra_msg::verdict_t& verdict :
       Said<terra_msg::verdict_t>(messages)) {
    last[verdict.session] = std::max(last[verdict.session], verdict.decision);
  }
  for (const deployed_t& deployed : Said<deployed_t>(messages)) {
    last[deployed.session] =
        std::max(last[deployed.session], deployed.decision);
  }
  std::int64_t all = 0;
  for (const auto& [session, decisions] : last) all += decisions;
  return all;
}

std::vector<std::uint8_t> LogOf(const Messages& messages) {
  std::vector<std::uint8_t> bytes;
  std::int64_t number = 0;
  for (const bus::RawMessage& message : messages) {
    AppendLogEvent(bytes, {number, kBetweenUs * number,
                           bus::BaseName(message.channel), message.bytes});
    ++number;
  }
  AppendLogEvent(bytes,
                 {number, kBetweenUs * number + kOthersUs, "OTHERS", {}});
  return bytes;
}

Audit AuditOf(const Messages& messages) {
  const std::vector<std::uint8_t> bytes = LogOf(messages);
  LogReader reader(bytes);
  return AuditLog(reader);
}

Audit AuditOfRecording(const Messages& messages) {
  const testing::TempFolder folder;
  Recorder recorder = Recorder::Start(folder.Path(""), {}, 0).value();
  const std::string path = recorder.path();
  std::int64_t now_us = 0;
  for (const bus::RawMessage& message : messages) {
    recorder.Record(
        {now_us, std::string(bus::BaseName(message.channel)), message.bytes});
    now_us += kBetweenUs;
  }
  now_us += kOthersUs;
  recorder.Record({now_us, "OTHERS", {}});
  EXPECT_TRUE(recorder.Close(now_us).ok());
  LogReader reader = LogReader::Open(path).value();
  return AuditLog(reader);
}

std::string Text(const Audit& audit) {
  std::string text;
  for (const Finding& finding : audit.findings) {
    text += std::string(KindName(finding.kind)) + " in session " +
            std::to_string(finding.session) + " at decision " +
            std::to_string(finding.decision) + ": " + finding.what + "\n";
  }
  return text;
}

}  // namespace terra::logger

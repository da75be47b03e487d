// The logger beside a whole set of real processes: what it records is audited
// and replayed; what goes wrong with it stops nobody.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <thread>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/codec.h"
#include "logger/audit.h"
#include "logger/log_contents.h"
#include "logger/log_info.h"
#include "terrain/segment.h"
#include "tests/support/bar_map.h"
#include "tests/system/robot.h"
#include "verifier/verify.h"

namespace terra {
namespace {

using std::chrono::milliseconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::pose_t;
using terra_msg::status_t;
using terra_msg::verdict_t;
using testing::BarMap;
using testing::BusPeer;
using testing::ChildProcess;
using testing::kBarGoal;
using testing::kBarStart;
using testing::ProgramPath;
using testing::Robot;
using testing::RunToEnd;

// What a fresh gate is to hear of a log, and nothing else.
constexpr const char* kInputs =
    "(TERRA_MAP_HEADER|TERRA_MAP_TILE|TERRA_PLAN_REQUEST|TERRA_BASELINE|"
    "TERRA_ADVICE|TERRA_POSE)";

// The same of its journal.
constexpr const char* kJournal =
    "(TERRA_MAP_HEADER|TERRA_MAP_TILE|TERRA_GATE_STEP)";

void StartDeployedPath(Robot& robot) {
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
}

std::string LogFolderOf(const Robot& robot) {
  return robot.folder().Path("log");
}

std::vector<std::string> LogsOf(const Robot& robot) {
  std::vector<std::string> logs;
  for (const auto& entry :
       std::filesystem::directory_iterator(LogFolderOf(robot))) {
    logs.push_back(entry.path().string());
  }
  std::sort(logs.begin(), logs.end());
  return logs;
}

logger::LogContents Read(const std::string& path) {
  Result<logger::LogReader> reader = logger::LogReader::Open(path);
  EXPECT_TRUE(reader.ok());
  logger::SealChecker seals;
  return logger::LogContents::Load(*reader, seals);
}

logger::LogInfo InfoOf(const std::string& path) {
  Result<logger::LogReader> reader = logger::LogReader::Open(path);
  EXPECT_TRUE(reader.ok());
  return logger::Inspect(*reader);
}

void ExpectCleanAudit(const std::string& log) {
  const auto audit = RunToEnd({ProgramPath("terra"), "log", "audit", log});
  EXPECT_EQ(audit.exit_code, 0) << log << ":\n" << audit.output;
}

// Of a part in which nothing was decided.
void ExpectNothingToAudit(const std::string& log) {
  const auto audit = RunToEnd({ProgramPath("terra"), "log", "audit", log});
  EXPECT_EQ(audit.exit_code, 1) << log << ":\n" << audit.output;
  EXPECT_THAT(audit.output, ::testing::HasSubstr("nothing to audit"));
}

advice_t AdviceOf(const std::string& advisor, const baseline_t& baseline) {
  advice_t advice{};
  advice.request_id = baseline.request_id;
  advice.map_id = baseline.map_id;
  advice.baseline_digest = baseline.baseline_digest;
  advice.anchor_x = baseline.start_x;
  advice.anchor_y = baseline.start_y;
  advice.advisor = advisor;
  advice.attempt = 1;
  advice.kind = advice_t::KIND_PROPOSE;
  return advice;
}

// A request that two advisors answer, and a third lies about.
void ServeRequest(Robot& robot, std::int64_t id, Cell start, Cell goal) {
  ASSERT_TRUE(robot.Ask(id, start, goal));
  const auto baseline =
      robot.deployed_bus().WaitFor<baseline_t>([id](const baseline_t& message) {
        return message.request_id == id;
      });
  ASSERT_TRUE(baseline);
  // Advice for a baseline that the gate has not heard of gets no verdict.
  ASSERT_TRUE(
      robot.deployed_bus().WaitFor<deployed_t>([&](const deployed_t& deployed) {
        return deployed.baseline_digest == baseline->baseline_digest;
      }));
  advice_t lie = AdviceOf("liar", *baseline);
  bus::SetWaypoints(lie, {start, {400, 3}, goal});
  robot.advice_bus().Send(lie);
  for (const char* advisor : {"searcher", "cutter", "liar"}) {
    ASSERT_TRUE(
        robot.deployed_bus().WaitFor<verdict_t>([&](const verdict_t& verdict) {
          return verdict.advisor == advisor && verdict.request_id == id;
        }))
        << advisor << ", request " << id;
  }
  // Two buses keep no order: the log may have an advice before its baseline.
  // Advisors repeat theirs, and so does this one.
  robot.advice_bus().Send(lie);
  for (const char* advisor : {"searcher", "cutter"}) {
    int heard = 0;
    ASSERT_TRUE(
        robot.advice_bus().WaitFor<advice_t>([&](const advice_t& advice) {
          return advice.advisor == advisor && advice.request_id == id &&
                 ++heard == 2;
        }));
  }
}

// What is in force when the gate has taken all that was said before: it repeats
// it in each turn.
std::optional<deployed_t> InForce(Robot& robot) {
  robot.deployed_bus().Forget();
  int heard = 0;
  return robot.deployed_bus().WaitFor<deployed_t>([&](const deployed_t&) {
    return ++heard == 3;
  });
}

// The robot drives; of two anchors on its way one is passed.
void Drive(Robot& robot, const deployed_t& deployed) {
  const CellPath cells = RasterizeRoute(bus::WaypointsOf(deployed));
  ASSERT_GT(cells.size(), 60U);
  pose_t pose{};
  pose.pose_x = cells[30].x;
  pose.pose_y = cells[30].y;
  pose.deployed_session = deployed.session;
  pose.deployed_route_seq = deployed.route_seq;
  robot.deployed_bus().Send(pose);
  ASSERT_TRUE(InForce(robot));
  for (const int index : {20, 60}) {
    advice_t advice{};
    advice.request_id = deployed.request_id;
    advice.map_id = deployed.map_id;
    advice.baseline_digest = deployed.baseline_digest;
    advice.anchor_session = deployed.session;
    advice.anchor_route_seq = deployed.route_seq;
    advice.anchor_index = index;
    const Cell anchor = cells[static_cast<std::size_t>(index)];
    advice.anchor_x = anchor.x;
    advice.anchor_y = anchor.y;
    advice.advisor = "driver";
    advice.attempt = index;
    advice.kind = advice_t::KIND_PROPOSE;
    bus::SetWaypoints(advice, {anchor, {deployed.goal_x, deployed.goal_y}});
    const auto judged = [&] {
      robot.advice_bus().Send(advice);
      return robot.deployed_bus().WaitFor<verdict_t>(
          [index](const verdict_t& verdict) {
            return verdict.advisor == "driver" && verdict.attempt == index;
          },
          milliseconds(200));
    };
    std::optional<verdict_t> verdict;
    for (int i = 0; i < 50 && !verdict; ++i) verdict = judged();
    ASSERT_TRUE(verdict);
    robot.advice_bus().Send(advice);
    EXPECT_EQ(verdict->code == verdict_t::CODE_LATE, index == 20);
  }
}

// What a gate decided about each request: its verdicts, by what they judged,
// and the route it deployed last.
struct Decided {
  using Judged = std::tuple<std::string, std::int64_t, std::int64_t, int>;
  std::map<Judged, verdict_t> verdicts;
  Route last_route;
  double last_cost = 0;
  std::int64_t last_decision = 0;
  std::int64_t baseline_us = 0;  // When its first baseline was logged.
  // Who gave advice, and when it was logged first, microseconds.
  std::vector<std::pair<std::string, std::int64_t>> advised;
  // When an advisor's first verdict was logged, microseconds.
  std::map<std::string, std::int64_t> judged_us;
};
using DecidedByRequest = std::map<std::int64_t, Decided>;

void Add(const verdict_t& verdict, DecidedByRequest& decided) {
  decided[verdict.request_id].verdicts.try_emplace(
      {verdict.advisor, verdict.advisor_session, verdict.attempt,
       verdict.candidate},
      verdict);
}

void Add(const deployed_t& deployed, DecidedByRequest& decided) {
  Decided& request = decided[deployed.request_id];
  if (deployed.num_waypoints == 0 ||
      deployed.decision < request.last_decision) {
    return;
  }
  request.last_decision = deployed.decision;
  request.last_route = bus::WaypointsOf(deployed);
  request.last_cost = deployed.deployed_cost;
}

DecidedByRequest DecidedIn(const logger::LogContents& log) {
  DecidedByRequest decided;
  for (const auto& [session, decisions] : log.decisions) {
    for (const auto& [number, logged] : decisions) {
      std::visit(
          [&](const auto& message) {
            Add(message, decided);
          },
          logged.message);
      if (const auto* verdict = std::get_if<verdict_t>(&logged.message)) {
        decided[verdict->request_id].judged_us.try_emplace(verdict->advisor,
                                                           logged.time_us);
      }
    }
  }
  for (const auto& [name, logged] : log.baselines) {
    std::int64_t& first = decided[logged.message.request_id].baseline_us;
    first = first == 0 ? logged.time_us : std::min(first, logged.time_us);
  }
  for (const auto& [name, variants] : log.advice) {
    decided[name.request_id].advised.emplace_back(
        variants.front().message.advisor, variants.front().time_us);
  }
  return decided;
}

DecidedByRequest DecidedBy(BusPeer& bus) {
  DecidedByRequest decided;
  for (const verdict_t& verdict : bus.Heard<verdict_t>()) Add(verdict, decided);
  for (const deployed_t& deployed : bus.Heard<deployed_t>()) {
    Add(deployed, decided);
  }
  return decided;
}

bool IsCheaper(std::int16_t code) {
  return code == verdict_t::CODE_ACCEPTED || code == verdict_t::CODE_NOT_BEST;
}

// When a cheaper route of that advisor, or of all others, was logged first.
std::vector<std::int64_t> TimesOfCheaperAdvice(const Decided& request,
                                               const std::string& advisor,
                                               bool of_others) {
  std::vector<std::int64_t> times;
  for (const auto& [name, time_us] : request.advised) {
    if ((name != advisor) != of_others) continue;
    const bool cheaper =
        std::ranges::any_of(request.verdicts, [&name = name](const auto& one) {
          return one.second.advisor == name && IsCheaper(one.second.code);
        });
    if (cheaper) times.push_back(time_us);
  }
  return times;
}

bool JudgedLate(const Decided& request) {
  return std::ranges::any_of(request.advised, [&](const auto& said) {
    const auto judged = request.judged_us.find(said.first);
    return judged != request.judged_us.end() &&
           judged->second - said.second > 50'000;
  });
}

// What two advisors said within 50 ms may be judged the other way round: two
// buses keep no order. Advice that the recorder or the gate heard before its
// baseline counts, in a replay or then, when it is repeated a second later.
bool MayHaveSwapped(const std::string& advisor, const Decided& request) {
  for (const std::int64_t own : TimesOfCheaperAdvice(request, advisor, false)) {
    for (const std::int64_t other :
         TimesOfCheaperAdvice(request, advisor, true)) {
      if (std::abs(own - other) <= 50'000) return true;
      if (std::min(own, other) <= request.baseline_us) return true;
      if (JudgedLate(request)) return true;
    }
  }
  return false;
}

bool SameCost(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool Swapped(const verdict_t& one, const verdict_t& again,
             const Decided& recorded) {
  return one.code != again.code && IsCheaper(one.code) &&
         IsCheaper(again.code) && MayHaveSwapped(one.advisor, recorded);
}

// Whether two advisors were judged the other way round. Then routes have other
// numbers from there on, and an anchor that names its route by number is on
// none.
bool AnySwapped(const Decided& recorded, const Decided& replayed) {
  return std::ranges::any_of(recorded.verdicts, [&](const auto& judged) {
    const auto found = replayed.verdicts.find(judged.first);
    return found != replayed.verdicts.end() &&
           Swapped(judged.second, found->second, recorded);
  });
}

void ExpectSame(const Decided& recorded, const Decided& replayed,
                bool renumbered) {
  if (AnySwapped(recorded, replayed)) {
    // Of two routes that are equally cheap the first stays.
    EXPECT_NEAR(recorded.last_cost, replayed.last_cost, verifier::kEpsilon);
  } else {
    EXPECT_EQ(recorded.last_route, replayed.last_route);
  }
  EXPECT_EQ(recorded.verdicts.size(), replayed.verdicts.size());
  for (const auto& [judged, verdict] : recorded.verdicts) {
    const auto found = replayed.verdicts.find(judged);
    ASSERT_NE(found, replayed.verdicts.end()) << verdict.advisor;
    const verdict_t& again = found->second;
    if (renumbered && verdict.anchor_route_seq != 0) continue;
    EXPECT_TRUE(verdict.code == again.code || Swapped(verdict, again, recorded))
        << verdict.advisor << ": " << verdict.code << " and " << again.code;
    EXPECT_TRUE(SameCost(verdict.candidate_cost, again.candidate_cost));
    EXPECT_TRUE(SameCost(verdict.baseline_cost, again.baseline_cost));
  }
}

// Plays some channels of a log into a verifier that hears nobody else, until
// `done` with what it says.
void Play(const std::string& log, const char* channels, std::int64_t session,
          const std::function<void(BusPeer& listener)>& done) {
  const testing::TestBus buses;
  BusPeer listener(buses.url());
  // One bus for both, since a player speaks on one.
  ChildProcess verifier({ProgramPath("terra-verifier"), "--lcm-url",
                         buses.url(), "--advice-url", buses.url(),
                         "--replay-session", std::to_string(session)});
  EXPECT_TRUE(listener.WaitFor<status_t>([](const status_t& status) {
    return status.status_name == "verifier";
  }));
  ChildProcess player(
      {"lcm-logplayer", "-l", buses.url(), "-e", channels, log});
  EXPECT_EQ(player.WaitForExit(std::chrono::minutes(1)), 0) << player.output();
  done(listener);
  EXPECT_EQ(verifier.Terminate(), 0);
}

DecidedByRequest Replay(const std::string& log, std::int64_t session) {
  DecidedByRequest decided;
  Play(log, kInputs, session, [&decided](BusPeer& listener) {
    // Of what was played last the verifier may still have some before it: it
    // has taken all when it has repeated what is in force a few times.
    std::size_t repeated = 0;
    const std::size_t before = listener.Heard<deployed_t>().size();
    EXPECT_TRUE(listener.WaitFor<deployed_t>([&](const deployed_t&) {
      return ++repeated == before + 3;
    }));
    decided = DecidedBy(listener);
  });
  return decided;
}

// Decisions by number, without what each sending changes.
using Numbered = std::map<std::int64_t, std::vector<std::uint8_t>>;

template <typename T>
void AddAll(BusPeer& listener, Numbered& decisions) {
  for (const T& message : listener.Heard<T>()) {
    decisions.try_emplace(message.decision, logger::Essence(message));
  }
}

Numbered ReplayJournal(const std::string& log, std::int64_t session,
                       std::size_t num_decisions) {
  Numbered decisions;
  Play(log, kJournal, session, [&](BusPeer& listener) {
    const bus::Time until = bus::Clock::now() + BusPeer::kPatience;
    do {
      AddAll<verdict_t>(listener, decisions);
      AddAll<deployed_t>(listener, decisions);
      listener.WaitFor<deployed_t>(
          [](const deployed_t&) {
            return false;
          },
          milliseconds(50));
    } while (decisions.size() < num_decisions && bus::Clock::now() < until);
  });
  return decisions;
}

TEST(FlightRecorder, ARunIsAuditedCleanAndReplayedToTheSameDecisions) {
  Robot robot(BarMap());
  ChildProcess& logger = robot.Start("logger", {"--out", LogFolderOf(robot)});
  ASSERT_TRUE(robot.WaitForReady("logger"));
  StartDeployedPath(robot);
  robot.Start("searcher", {"--backend", "search"});
  robot.Start("cutter", {"--backend", "shortcut"});
  ServeRequest(robot, 11, kBarStart, kBarGoal);
  ServeRequest(robot, 12, {5, 100}, {155, 20});
  ServeRequest(robot, 13, {20, 110}, {150, 110});
  // The newest: advisors improve each other's routes.
  const auto deployed = InForce(robot);
  ASSERT_TRUE(deployed && deployed->mode == deployed_t::MODE_CANDIDATE);
  Drive(robot, *deployed);
  ASSERT_EQ(logger.Terminate(), 0);
  const std::string log = LogsOf(robot).at(0);
  ExpectCleanAudit(log);

  const logger::LogContents contents = Read(log);
  const DecidedByRequest recorded = DecidedIn(contents);
  ASSERT_EQ(contents.decisions.size(), 1U);
  const DecidedByRequest replayed =
      Replay(log, contents.decisions.begin()->first);
  Numbered decisions;
  for (const auto& [number, logged] : contents.decisions.begin()->second) {
    decisions[number] = logger::Essence(logged.message);
  }
  EXPECT_EQ(
      ReplayJournal(log, contents.decisions.begin()->first, decisions.size()),
      decisions);
  ASSERT_EQ(recorded.size(), 3U);
  bool renumbered = false;
  for (const auto& [request, decided] : recorded) {  // 11, 12, 13: in order
    SCOPED_TRACE(request);
    EXPECT_FALSE(decided.last_route.empty());
    EXPECT_GE(decided.verdicts.size(), 3U);
    ASSERT_TRUE(replayed.contains(request));
    renumbered |= AnySwapped(decided, replayed.at(request));
    ExpectSame(decided, replayed.at(request), renumbered);
  }
}

std::uintmax_t BytesLogged(const Robot& robot) {
  std::uintmax_t bytes = 0;
  for (const std::string& log : LogsOf(robot)) {
    bytes += std::filesystem::file_size(log);
  }
  return bytes;
}

void SendPose(Robot& robot, int x) {
  pose_t pose{};
  pose.pose_x = x;
  robot.deployed_bus().Send(pose);
}

// What the smallest receive buffer of a kernel holds, and some time to read it.
void SendPoses(Robot& robot, int count) {
  for (int i = 0; i < count; ++i) {
    SendPose(robot, i);
    if (i % 50 == 49) std::this_thread::sleep_for(milliseconds(2));
  }
}

// The same for a logger that may not be scheduled for long: the next poses when
// these are on the disk.
void SendPosesAsTheyAreLogged(Robot& robot, int count) {
  constexpr int kAtOnce = 500;
  constexpr std::uintmax_t kBytesEach = 100;  // 110 in the log
  for (int i = 0; i < count;) {
    const std::uintmax_t before = BytesLogged(robot);
    for (int n = 0; n < kAtOnce && i < count; ++n, ++i) {
      SendPose(robot, i);
    }
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (BytesLogged(robot) < before + kAtOnce * kBytesEach) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << "poses were lost";
      std::this_thread::sleep_for(milliseconds(5));
    }
  }
}

TEST(FlightRecorder, EachPartOfARotatedLogIsAuditedAlone) {
  Robot robot(BarMap());
  ChildProcess& logger =
      robot.Start("logger", {"--out", LogFolderOf(robot), "--part-mb", "1"});
  ASSERT_TRUE(robot.WaitForReady("logger"));
  StartDeployedPath(robot);
  robot.Start("searcher", {"--backend", "search"});
  for (std::int64_t request = 11; request < 14; ++request) {
    ASSERT_TRUE(robot.Ask(request, kBarStart, kBarGoal));
    ASSERT_TRUE(robot.WaitForDeployed(request, deployed_t::MODE_CANDIDATE));
    SendPosesAsTheyAreLogged(robot, 8'000);
  }
  ASSERT_EQ(logger.Terminate(), 0);
  const std::vector<std::string> parts = LogsOf(robot);
  ASSERT_GE(parts.size(), 3U);
  std::int64_t poses = 0;
  int judged_parts = 0;
  for (const std::string& part : parts) {
    const logger::LogInfo info = InfoOf(part);
    EXPECT_TRUE(info.intact() && info.closed) << part;
    if (info.channels.contains("TERRA_VERDICT")) {
      ExpectCleanAudit(part);
      ++judged_parts;
    } else {
      ExpectNothingToAudit(part);
    }
    poses += info.channels.at("TERRA_POSE").events;
  }
  EXPECT_EQ(poses, 24'000);
  EXPECT_GE(judged_parts, 2);
}

// Gate and recorder look at other parts of a flood; what the gate judged is in
// its journal.
TEST(FlightRecorder, AFloodOfAdviceIsNotRecordedAndCostsNoOtherMessage) {
  Robot robot(BarMap());
  ChildProcess& logger = robot.Start("logger", {"--out", LogFolderOf(robot)});
  ASSERT_TRUE(robot.WaitForReady("logger"));
  StartDeployedPath(robot);
  ASSERT_TRUE(robot.Ask(11, kBarStart, kBarGoal));
  ASSERT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_BASELINE));
  const auto baselines = robot.deployed_bus().Heard<baseline_t>();
  ASSERT_FALSE(baselines.empty());
  advice_t advice = AdviceOf("babbler", baselines.back());
  bus::SetWaypoints(advice, {kBarStart, {400, 3}, kBarGoal});
  std::atomic<bool> stop = false;
  std::atomic<std::int64_t> sent = 0;
  std::thread flood([&] {
    for (; !stop; ++sent) {
      advice.attempt = sent;
      robot.advice_bus().Send(advice);
    }
  });
  SendPoses(robot, 10'000);
  stop = true;
  flood.join();
  ASSERT_EQ(logger.Terminate(), 0);
  const std::string log = LogsOf(robot).at(0);
  ExpectCleanAudit(log);
  const logger::LogInfo info = InfoOf(log);
  EXPECT_EQ(info.channels.at("TERRA_POSE").events, 10'000);
  // 20 a second of one sender.
  const std::int64_t heard = info.channels.at("TERRA_ADVICE").events;
  const double seconds =
      1e-6 * static_cast<double>(info.last_us - info.first_us);
  EXPECT_LE(static_cast<double>(heard), 20 * (seconds + 1));
  EXPECT_GT(sent, 10 * heard);
  Result<logger::LogReader> reader = logger::LogReader::Open(log);
  ASSERT_TRUE(reader.ok());
  const logger::Audit audit = logger::AuditLog(*reader);
  EXPECT_GT(audit.verdicts, 0);
  EXPECT_EQ(audit.unrecorded, 0);
}

TEST(FlightRecorder, WithoutAFolderToWriteToItEndsAndTheOthersServe) {
  Robot robot(BarMap());
  ChildProcess& logger = robot.Start("logger", {"--out", "/proc/no-such/log"});
  EXPECT_EQ(logger.WaitForExit(BusPeer::kPatience), 1);
  EXPECT_NE(logger.output().find("/proc/no-such/log"), std::string::npos)
      << logger.output();
  StartDeployedPath(robot);
  robot.Start("searcher");
  ASSERT_TRUE(robot.Ask(11, kBarStart, kBarGoal));
  EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE));
}

// What a heartbeat of the logger says it has on the disk; nothing for others.
std::optional<std::int64_t> Acknowledged(const status_t& status) {
  if (status.status_name != "logger") return std::nullopt;
  const auto name = std::ranges::find(status.counter_name, "acknowledged");
  if (name == status.counter_name.end()) return std::nullopt;
  return status.counter_value[static_cast<std::size_t>(
      name - status.counter_name.begin())];
}

// Waits until so many events are on the disk; returns how many there are.
std::optional<std::int64_t> WaitForAcknowledged(Robot& robot,
                                                std::int64_t events) {
  const auto heartbeat =
      robot.deployed_bus().WaitFor<status_t>([=](const status_t& status) {
        return Acknowledged(status).value_or(-1) >= events;
      });
  return heartbeat ? Acknowledged(*heartbeat) : std::nullopt;
}

TEST(FlightRecorder, AFullDiskIsReportedAndTheOthersServe) {
  Robot robot(BarMap());
  const std::string disk = robot.folder().Path("disk");
  std::filesystem::create_directories(disk);
  const std::string mount = "mount -t tmpfs -o size=64k none " + disk;
  if (std::system(("unshare -m sh -c '" + mount + "' 2>/dev/null").c_str()) !=
      0) {
    GTEST_SKIP() << "no permission to mount a small disk";
  }
  std::string start =
      mount + " && exec " + ProgramPath("terra-logger") + " --out " + disk;
  for (const std::string& option : robot.BusOptions()) {
    start += " '" + option + "'";
  }
  ChildProcess logger({"unshare", "-m", "sh", "-c", start});
  // Some that fit, and are on the disk, before those that do not: a batch that
  // does not fit as a whole is not begun.
  constexpr int kFit = 50;
  const auto before = WaitForAcknowledged(robot, 1);
  ASSERT_TRUE(before) << logger.output();
  SendPoses(robot, kFit);
  ASSERT_TRUE(WaitForAcknowledged(robot, *before + kFit)) << logger.output();
  StartDeployedPath(robot);
  SendPoses(robot, 2'000);
  const auto failing =
      robot.deployed_bus().WaitFor<status_t>([](const status_t& status) {
        return status.status_name == "logger" &&
               status.state.starts_with("failing");
      });
  ASSERT_TRUE(failing) << logger.output();
  EXPECT_NE(failing->last_error.find("No space left"), std::string::npos);
  robot.Start("searcher");
  ASSERT_TRUE(robot.Ask(11, kBarStart, kBarGoal));
  EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE));
  // What fitted is whole.
  const std::string seen =
      "/proc/" + std::to_string(logger.pid()) + "/root" + disk;
  std::int64_t events = 0;
  for (const auto& entry : std::filesystem::directory_iterator(seen)) {
    const logger::LogInfo info = InfoOf(entry.path().string());
    EXPECT_TRUE(info.intact());
    events += info.events;  // a part that was begun when it failed has few
  }
  EXPECT_GE(events, kFit);
  EXPECT_EQ(logger.Terminate(), 1);
}

}  // namespace
}  // namespace terra

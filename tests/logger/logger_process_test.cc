// terra-logger as a process: killed, without room, without permission, and
// under a burst; its files in the hands of LCM's own player.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "logger/log_info.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_bus.h"

namespace terra::logger {
namespace {

using std::chrono::milliseconds;
using terra_msg::pose_t;
using terra_msg::status_t;
using testing::BusPeer;
using testing::ChildProcess;
using testing::ProgramPath;
using testing::TempFolder;
using testing::TestBus;

std::int64_t CounterOf(const status_t& status, const std::string& name) {
  const auto found =
      std::find(status.counter_name.begin(), status.counter_name.end(), name);
  return found == status.counter_name.end()
             ? -1
             : status.counter_value[static_cast<std::size_t>(
                   found - status.counter_name.begin())];
}

class LoggerProcess : public ::testing::Test {
 protected:
  LoggerProcess() : peer_(buses_.url()) {}

  std::vector<std::string> Command() const {
    return CommandInto(folder_.Path("log"));
  }
  std::vector<std::string> CommandInto(const std::string& folder) const {
    return {
        ProgramPath("terra-logger"), "--lcm-url", buses_.url(), "--advice-url",
        buses_.advice_url(),         "--out",     folder};
  }

  // Waits for a heartbeat of the logger that the predicate likes.
  std::optional<status_t> Heartbeat(
      const std::function<bool(const status_t&)>& wanted) {
    return peer_.WaitFor<status_t>([&](const status_t& status) {
      return status.status_name == "logger" && wanted(status);
    });
  }
  bool WaitUntilReady() {
    return Heartbeat([](const status_t& status) {
             return status.state.starts_with("ready");
           })
        .has_value();
  }

  void SendPoses(int count) {
    for (int i = 0; i < count; ++i) {
      pose_t pose{};
      pose.pose_x = i;
      peer_.Send(pose);
      // What the smallest receive buffer of a kernel holds, and some time to
      // read it.
      if (i % 50 == 49) std::this_thread::sleep_for(milliseconds(1));
    }
  }

  std::vector<std::string> Logs() const {
    std::vector<std::string> logs;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder_.Path("log"))) {
      logs.push_back(entry.path().string());
    }
    std::sort(logs.begin(), logs.end());
    return logs;
  }
  LogInfo InfoOf(const std::string& path) const {
    Result<LogReader> reader = LogReader::Open(path);
    EXPECT_TRUE(reader.ok());
    return Inspect(*reader);
  }

  TestBus buses_;
  TempFolder folder_;
  BusPeer peer_;
};

TEST_F(LoggerProcess, RecordsABurstOfTenThousandMessagesWithoutLoss) {
  ChildProcess logger(Command());
  ASSERT_TRUE(WaitUntilReady());
  SendPoses(10'000);
  ASSERT_TRUE(Heartbeat([](const status_t& status) {
    return CounterOf(status, "acknowledged") >= 10'000;
  }));
  EXPECT_EQ(logger.Terminate(), 0);
  const LogInfo info = InfoOf(Logs().at(0));
  EXPECT_TRUE(info.intact());
  EXPECT_TRUE(info.closed);
  EXPECT_EQ(info.channels.at("TERRA_POSE").events, 10'000);
  EXPECT_EQ(info.channels.at("TERRA_POSE").missing, 0);
}

TEST_F(LoggerProcess, WhatItAcknowledgedSurvivesAKillAtAnyMoment) {
  for (int round = 0; round < 5; ++round) {
    peer_.Forget();
    ChildProcess logger(Command());
    ASSERT_TRUE(WaitUntilReady());
    // A heartbeat tells how much is acknowledged while more keeps coming.
    std::int64_t acknowledged = 0;
    for (int i = 0; acknowledged == 0 && i < 10'000; ++i) {
      SendPoses(50 + round * 17);
      for (const status_t& status : peer_.Heard<status_t>()) {
        if (status.status_name == "logger" &&
            CounterOf(status, "acknowledged") > 200) {
          acknowledged = CounterOf(status, "acknowledged");
        }
      }
    }
    logger.Kill();
    ASSERT_GT(acknowledged, 0);
    const LogInfo info = InfoOf(Logs().at(static_cast<std::size_t>(round)));
    EXPECT_GE(info.events, acknowledged);
    EXPECT_EQ(info.num_broken_seals, 0);
    for (const LogDamage& damage : info.damage) EXPECT_TRUE(damage.torn_end);
    EXPECT_FALSE(info.closed);
  }
  EXPECT_EQ(Logs().size(), 5U);  // a new file for each start
}

// The x of the file's last event if that is a POSE; -1 else.
int LastPose(const std::string& path) {
  Result<LogReader> reader = LogReader::Open(path);
  int last = -1;
  while (const auto item = reader->Next()) {
    if (item->event.channel == "TERRA_LOG") continue;
    const auto pose = bus::Decode<pose_t>(item->event.data);
    last = pose ? pose->pose_x : -1;
  }
  return last;
}

// LCM's own logger writes only when a further message arrives.
TEST_F(LoggerProcess, AMessageIsOnTheDiskBeforeAnotherOneComes) {
  ChildProcess logger(Command());
  ASSERT_TRUE(WaitUntilReady());
  const std::string log = Logs().at(0);
  bool seen_alone = false;
  // A heartbeat may come in between, but not each time.
  for (int i = 1; i <= 10 && !seen_alone; ++i) {
    pose_t pose{};
    pose.pose_x = i;
    peer_.Send(pose);
    for (int look = 0; look < 100 && !seen_alone; ++look) {
      seen_alone = LastPose(log) == i;
      if (!seen_alone) std::this_thread::sleep_for(milliseconds(5));
    }
  }
  EXPECT_TRUE(seen_alone);
}

TEST_F(LoggerProcess, LcmsOwnPlayerPlaysTheFile) {
  ChildProcess logger(Command());
  ASSERT_TRUE(WaitUntilReady());
  SendPoses(100);
  ASSERT_TRUE(Heartbeat([](const status_t& status) {
    return CounterOf(status, "acknowledged") >= 100;
  }));
  ASSERT_EQ(logger.Terminate(), 0);
  BusPeer listener(buses_.advice_url());  // another port
  ChildProcess player({"lcm-logplayer", "-l", buses_.advice_url(), "-e",
                       "TERRA_POSE", Logs().at(0)});
  ASSERT_EQ(player.WaitForExit(std::chrono::seconds(30)), 0) << player.output();
  EXPECT_TRUE(listener.WaitFor<pose_t>([](const pose_t& pose) {
    return pose.pose_x == 99;
  }));
  EXPECT_EQ(listener.Heard<pose_t>().size(), 100U);
}

TEST_F(LoggerProcess, AFileLimitIsReportedLikeAFullDisk) {
  std::vector<std::string> command = {"prlimit", "--fsize=20000"};
  const std::vector<std::string> logger_command = Command();
  command.insert(command.end(), logger_command.begin(), logger_command.end());
  ChildProcess logger(command);
  ASSERT_TRUE(WaitUntilReady());
  SendPoses(1'000);
  const auto failing = Heartbeat([](const status_t& status) {
    return status.state.starts_with("failing");
  });
  ASSERT_TRUE(failing);
  EXPECT_NE(failing->last_error.find("cannot write"), std::string::npos);
  EXPECT_EQ(logger.Terminate(), 1);
  // What is there is whole.
  const LogInfo info = InfoOf(Logs().at(0));
  EXPECT_TRUE(info.intact());
  EXPECT_GT(info.events, 0);
}

TEST_F(LoggerProcess, AFullDiskIsReportedOnTheBusAndInTheExitCode) {
  const std::string mount = folder_.Path("disk");
  std::filesystem::create_directories(mount);
  const std::string make_disk = "mount -t tmpfs -o size=64k none " + mount;
  if (std::system(
          ("unshare -m sh -c '" + make_disk + "' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "no permission to mount a small disk";
  }
  std::string start = make_disk + " && exec";
  for (const std::string& word : CommandInto(mount + "/log")) {
    start += " '" + word + "'";
  }
  ChildProcess logger({"unshare", "-m", "sh", "-c", start});
  ASSERT_TRUE(WaitUntilReady()) << logger.output();
  SendPoses(2'000);
  const auto failing = Heartbeat([](const status_t& status) {
    return status.state.starts_with("failing");
  });
  ASSERT_TRUE(failing);
  EXPECT_NE(failing->last_error.find("No space left"), std::string::npos);
  EXPECT_EQ(logger.Terminate(), 1);
}

TEST_F(LoggerProcess, ABusyPortEndsItWithTheReason) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string port = std::to_string(ntohs(address.sin_port));
  const testing::RunResult result = testing::RunToEnd(
      {ProgramPath("terra-logger"), "--out", folder_.Path("log"), "--lcm-url",
       "udpm://239.255.76.67:" + port + "?ttl=0"});
  close(fd);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find(port + " is taken by another program"),
            std::string::npos)
      << result.output;
}

TEST_F(LoggerProcess, AFolderWithoutPermissionEndsItWithTheReason) {
  if (geteuid() == 0) {
    // Root may write anywhere but into /proc.
    const testing::RunResult result =
        testing::RunToEnd(CommandInto("/proc/terra-log"));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.output.find("/proc/terra-log"), std::string::npos);
    return;
  }
  const std::string folder = folder_.Path("read-only");
  std::filesystem::create_directory(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_read |
                                           std::filesystem::perms::owner_exec);
  const testing::RunResult result = testing::RunToEnd(CommandInto(folder));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find(folder), std::string::npos);
}

}  // namespace
}  // namespace terra::logger

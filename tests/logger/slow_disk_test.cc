// terra-logger on a disk that does not answer for a while.
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

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

// Stands for systemd: hears sd_notify(3).
class ServiceManager {
 public:
  explicit ServiceManager(const std::string& path)
      : fd_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&address),
             sizeof address) != 0) {
      throw std::runtime_error("cannot bind " + path);
    }
  }
  ~ServiceManager() { close(fd_); }

  // Waits for so many signs of life; false when one takes longer than systemd
  // would wait (WatchdogSec of the shipped unit).
  bool HearWatchdog(int times) {
    constexpr int kWatchdogMs = 5'000;
    pollfd readable{fd_, POLLIN, 0};
    std::array<char, 4096> text{};
    while (times > 0) {
      if (poll(&readable, 1, kWatchdogMs) != 1) return false;
      const ssize_t got = recv(fd_, text.data(), text.size(), 0);
      const std::string_view said(text.data(), static_cast<std::size_t>(got));
      if (said.find("WATCHDOG=1") != std::string_view::npos) --times;
    }
    return true;
  }
  void Forget() {
    std::array<char, 4096> text{};
    while (recv(fd_, text.data(), text.size(), MSG_DONTWAIT) > 0) {
    }
  }

 private:
  int fd_;
};

class SlowDisk : public ::testing::Test {
 protected:
  SlowDisk()
      : manager_(folder_.Path("notify")),
        peer_(buses_.url()),
        logger_({"env", "LD_PRELOAD=" TERRA_STUCK_DISK_LIBRARY,
                 "TERRA_STUCK_DISK=" + folder_.Path("stuck"),
                 "NOTIFY_SOCKET=" + folder_.Path("notify"),
                 testing::ProgramPath("terra-logger"), "--lcm-url",
                 buses_.url(), "--advice-url", buses_.advice_url(), "--out",
                 folder_.Path("log")}) {}

  bool WaitForState(const std::string& beginning) {
    return peer_
        .WaitFor<status_t>([&](const status_t& status) {
          return status.status_name == "logger" &&
                 status.state.starts_with(beginning);
        })
        .has_value();
  }
  void StopDisk() { folder_.Write("stuck", ""); }
  void ResumeDisk() { std::filesystem::remove(folder_.Path("stuck")); }
  void SendPoses(int count) {
    for (int i = 0; i < count; ++i) {
      pose_t pose{};
      pose.pose_x = i;
      peer_.Send(pose);
      if (i % 50 == 49) {
        std::this_thread::sleep_for(milliseconds(1));
      }
    }
  }
  LogInfo Info() const {
    const auto file =
        std::filesystem::directory_iterator(folder_.Path("log"))->path();
    Result<LogReader> reader = LogReader::Open(file.string());
    EXPECT_TRUE(reader.ok());
    return Inspect(*reader);
  }

  testing::TestBus buses_;
  testing::TempFolder folder_;
  ServiceManager manager_;
  BusPeer peer_;
  ChildProcess logger_;
};

TEST_F(SlowDisk, IsSaidAndCostsNothingThatMemoryHolds) {
  constexpr int kPoses = 5'000;
  ASSERT_TRUE(WaitForState("ready")) << logger_.output();
  StopDisk();
  SendPoses(kPoses);
  ASSERT_TRUE(WaitForState("failing: the disk of "));
  manager_.Forget();
  // Longer than the watchdog waits.
  EXPECT_TRUE(manager_.HearWatchdog(7));
  EXPECT_TRUE(logger_.running());
  peer_.Forget();
  ResumeDisk();
  ASSERT_TRUE(WaitForState("ready"));
  EXPECT_EQ(logger_.Terminate(), 0) << logger_.output();
  const LogInfo info = Info();
  EXPECT_TRUE(info.closed);
  EXPECT_EQ(info.lost, 0);
  EXPECT_EQ(info.channels.at("TERRA_POSE").events, kPoses);
}

TEST_F(SlowDisk, IsWaitedForAtTheEnd) {
  constexpr int kPoses = 100;
  ASSERT_TRUE(WaitForState("ready")) << logger_.output();
  StopDisk();
  SendPoses(kPoses);
  ASSERT_TRUE(WaitForState("failing: the disk of "));
  logger_.Signal(SIGTERM);
  EXPECT_FALSE(logger_.WaitForExit(milliseconds(300)));
  ResumeDisk();
  EXPECT_EQ(logger_.WaitForExit(milliseconds(20'000)), 0) << logger_.output();
  EXPECT_EQ(Info().channels.at("TERRA_POSE").events, kPoses);
  EXPECT_TRUE(Info().closed);
}

}  // namespace
}  // namespace terra::logger

// The set as real processes on buses of other kinds than the usual one: a hub
// that goes away and comes back, URLs that leave parts out, a bus that reaches
// nobody.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/files/map_file.h"
#include "tests/support/bar_map.h"
#include "tests/support/captured_errors.h"
#include "tests/support/child_process.h"
#include "tests/support/tcpq_hub.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_bus.h"

namespace terra {
namespace {

using std::chrono::seconds;
using testing::ChildProcess;
using testing::ProgramPath;
using testing::RunToEnd;
using testing::TcpqHub;
using testing::TimesIn;

constexpr seconds kPatience = testing::BusPeer::kPatience;

// Every process of the set, with the same bus options.
class BusUrlTest : public ::testing::Test {
 protected:
  void StartAll(const std::vector<std::string>& bus) {
    bus_ = bus;
    const std::string map = folder_.Path("map.png");
    ASSERT_TRUE(WriteIdPng(testing::BarMap(), map).ok());
    Start("terra-map", {"--map", map});
    Start("terra-planner", {"--stride", "20"});
    Start("terra-verifier", {});
    Start("terra-advisor", {"--backend", "search"});
    Start("terra-logger", {"--out", folder_.Path("log")});
  }

  testing::RunResult Request(const std::string& wait = "20") {
    std::vector<std::string> command = {ProgramPath("terra"), "request"};
    command.insert(command.end(), bus_.begin(), bus_.end());
    command.insert(command.end(), {"--start", "5,60", "--goal", "155,60",
                                   "--wait", wait, "--json"});
    return RunToEnd(command);
  }
  void ExpectCandidate() {
    const auto request = Request();
    EXPECT_EQ(request.exit_code, 0) << request.output;
    EXPECT_NE(request.output.find("\"deployed\":\"candidate\""),
              std::string::npos)
        << request.output;
  }

  std::vector<std::string> bus_;
  testing::TempFolder folder_;
  std::map<std::string, std::unique_ptr<ChildProcess>> processes_;

 private:
  void Start(const std::string& program, std::vector<std::string> options) {
    options.insert(options.begin(), ProgramPath(program));
    options.insert(options.end(), bus_.begin(), bus_.end());
    processes_[program] = std::make_unique<ChildProcess>(options);
  }
};

TEST_F(BusUrlTest, AHubThatGoesAwayTakesNoProcessWithIt) {
  std::optional<TcpqHub> hub(std::in_place);
  const int port = hub->port();
  StartAll({"--lcm-url", hub->url()});
  ExpectCandidate();
  hub.reset();
  for (const auto& [name, process] : processes_) {
    EXPECT_TRUE(process->WaitForOutput("went away", kPatience)) << name;
  }
  const auto without = Request("0");
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.output.find("no hub answers"), std::string::npos)
      << without.output;
  hub.emplace(port);
  for (const auto& [name, process] : processes_) {
    EXPECT_TRUE(process->WaitForOutput("is back", kPatience)) << name;
  }
  ExpectCandidate();
  for (const auto& [name, process] : processes_) {
    const std::string output = process->output();
    EXPECT_LE(TimesIn(output, "went away"), 2) << "once a bus: " << output;
    EXPECT_LT(output.size(), 5'000U) << name << ": " << output;
    EXPECT_EQ(process->Terminate(), 0) << name << ": " << output;
  }
}

TEST_F(BusUrlTest, AnAdviceUrlMayLeaveOutWhatAnyUrlMayLeaveOut) {
  const testing::TestBus buses;
  if (!buses.in_own_namespace()) {
    GTEST_SKIP() << "needs a network of its own, to use LCM's default port";
  }
  StartAll({"--lcm-url", "udpm://239.255.76.67:7000?ttl=0", "--advice-url",
            "udpm://239.255.76.67?ttl=0"});
  ExpectCandidate();
  for (const auto& [name, process] : processes_) {
    EXPECT_EQ(process->Terminate(), 0) << name << ": " << process->output();
  }
}

TEST_F(BusUrlTest, ABadUrlIsRefusedByEveryProcess) {
  StartAll({"--lcm-url", "udpm://239.255.76.67:7000?ttl=0", "--advice-url",
            "udpm://239.255.76.67:07001?ttl=0"});
  for (const auto& [name, process] : processes_) {
    EXPECT_EQ(process->WaitForExit(kPatience), 2) << name;
    EXPECT_NE(process->output().find("the port must be"), std::string::npos)
        << process->output();
  }
}

TEST_F(BusUrlTest, OnMemqEveryProcessSaysThatItReachesNobody) {
  StartAll({"--lcm-url", "memq://"});
  for (const auto& [name, process] : processes_) {
    EXPECT_TRUE(process->WaitForOutput("no other process is heard", kPatience))
        << name << ": " << process->output();
  }
  const auto request = Request("0");
  EXPECT_EQ(request.exit_code, 1);
  EXPECT_NE(request.output.find("no other process is heard"), std::string::npos)
      << request.output;
}

}  // namespace
}  // namespace terra

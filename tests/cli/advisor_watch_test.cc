#include "cli/advisor_watch.h"

#include <string>

#include <gtest/gtest.h>

#include "bus/process_state.h"

namespace terra::cli {
namespace {

terra_msg::status_t Heartbeat(const std::string& name, const std::string& state,
                              std::int64_t failures, const std::string& error) {
  terra_msg::status_t status{};
  status.status_name = name;
  status.host = "h";
  status.state = state;
  status.counter_name = {"jobs", "failures"};
  status.counter_value = {1, failures};
  status.num_counters = 2;
  status.last_error = error;
  return status;
}

void Hear(AdvisorWatch& watch, const terra_msg::status_t& status, int times) {
  for (int i = 0; i < times; ++i) watch.OnStatus(status);
}

TEST(AdvisorWatchTest, WithoutAdvisorsNobodyGaveUp) {
  AdvisorWatch watch;
  terra_msg::status_t planner{};
  planner.status_name = "planner";
  planner.last_error = "x";
  Hear(watch, planner, 10);
  EXPECT_FALSE(watch.AllGaveUp());
  EXPECT_TRUE(watch.advisors().empty());
}

TEST(AdvisorWatchTest, OneFailedCallAndThreeIdleHeartbeatsAreEnough) {
  for (const char* state : {"ready", "failing: breaker open"}) {
    AdvisorWatch watch;
    Hear(watch, Heartbeat("a", state, 1, "HTTP 404"), 2);
    EXPECT_FALSE(watch.AllGaveUp());
    Hear(watch, Heartbeat("a", state, 1, "HTTP 404"), 1);
    EXPECT_TRUE(watch.AllGaveUp());
    EXPECT_EQ(watch.advisors().at(0).error, "HTTP 404");
  }
}

TEST(AdvisorWatchTest, WhoWorksOrWaitsOrNeverFailedIsWaitedFor) {
  for (const char* state : {"working", "ready: waiting for the robot",
                            "waiting for map", "starting"}) {
    AdvisorWatch watch;
    Hear(watch, Heartbeat("a", state, 1, "HTTP 404"), 10);
    EXPECT_FALSE(watch.AllGaveUp()) << state;
  }
  AdvisorWatch watch;
  Hear(watch, Heartbeat("a", "ready", 0, "malformed"), 10);
  EXPECT_FALSE(watch.AllGaveUp());
}

TEST(AdvisorWatchTest, AWorkingAdvisorIsNotForgottenForAnOthersFailure) {
  AdvisorWatch watch;
  Hear(watch, Heartbeat("a", "ready", 1, "x"), 10);
  Hear(watch, Heartbeat("b", "working", 0, ""), 1);
  EXPECT_FALSE(watch.AllGaveUp());
  EXPECT_EQ(watch.advisors().size(), 2u);
}

TEST(AdvisorWatchTest, WorkStartsTheCountAnew) {
  AdvisorWatch watch;
  Hear(watch, Heartbeat("a", "ready", 1, "x"), 2);
  Hear(watch, Heartbeat("a", "working", 1, "x"), 1);
  Hear(watch, Heartbeat("a", "ready", 2, "x"), 2);
  EXPECT_FALSE(watch.AllGaveUp());
}

TEST(AdvisorWatchTest, TellsTheErrorOfOneAdvisor) {
  AdvisorWatch watch;
  Hear(watch, Heartbeat("a", "ready", 0, "no_list"), 1);
  Hear(watch, Heartbeat("b", "ready", 1, "refused"), 1);
  EXPECT_EQ(watch.ErrorOf("a"), "no_list");
  EXPECT_EQ(watch.ErrorOf("b"), "refused");
  EXPECT_EQ(watch.ErrorOf("c"), "");
}

TEST(AdvisorWatchTest, AFloodOfNamesIsBoundedAndFitForATerminal) {
  AdvisorWatch watch;
  for (int i = 0; i < 1'000; ++i) {
    watch.OnStatus(Heartbeat("\x1b[2J" + std::to_string(i), "ready", 1, "x"));
  }
  EXPECT_LE(watch.advisors().size(), 64u);
  EXPECT_EQ(watch.advisors().at(0).name.find('\x1b'), std::string::npos);
}

TEST(ProcessState, IsReadFromTheFirstWordOfItsText) {
  using bus::ProcessState;
  EXPECT_EQ(bus::StateOf("ready"), ProcessState::kReady);
  EXPECT_EQ(bus::StateOf("ready: waiting for the robot"),
            ProcessState::kWaiting);
  EXPECT_TRUE(bus::DoesItsWork(ProcessState::kWaiting));
  EXPECT_EQ(bus::StateOf("working"), ProcessState::kWorking);
  EXPECT_EQ(bus::StateOf("failing: breaker open"), ProcessState::kFailing);
  EXPECT_EQ(bus::StateOf("failing"), ProcessState::kFailing);
  for (const char* other : {"", "waiting for map", "readying", "not ready"}) {
    EXPECT_EQ(bus::StateOf(other), ProcessState::kOther) << other;
  }
}

}  // namespace
}  // namespace terra::cli

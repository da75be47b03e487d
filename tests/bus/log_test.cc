// What is logged, by a program of its own with a standard error of its own.
#include "bus/log.h"

#include <csignal>
#include <string>

#include <gtest/gtest.h>

#include "bus/time.h"
#include "tests/support/child_process.h"
#include "tests/support/unread_output.h"

namespace terra::bus {
namespace {

using std::chrono::milliseconds;
using testing::ChildProcess;
using testing::UnreadOutput;

constexpr milliseconds kPatience{20'000};
constexpr int kMoreThanQueued = 5000;

std::vector<std::string> LogLines(std::vector<std::string> before, int lines) {
  before.insert(before.end(), {TERRA_LOG_LINES, std::to_string(lines)});
  return before;
}

TEST(Log, WritesAllLinesInOrderBeforeTheProgramEnds) {
  constexpr int kLines = 500;
  ChildProcess program(LogLines({}, kLines));
  ASSERT_TRUE(program.WaitForOutput("dropped 0\n", kPatience));
  program.Signal(SIGUSR1);
  ASSERT_EQ(program.WaitForExit(kPatience), 0);
  const std::string said = program.output();
  std::size_t at = 0;
  for (int i = 0; i < kLines; ++i) {
    at = said.find(" lines warning: line " + std::to_string(i) + "\n", at);
    ASSERT_NE(at, std::string::npos) << i;
  }
}

class UnreadLog : public ::testing::TestWithParam<UnreadOutput::Kind> {};

TEST_P(UnreadLog, HoldsNobodyUpAndCountsWhatItDrops) {
  const UnreadOutput unread(GetParam());
  ChildProcess program(LogLines(unread.AsStandardErrorOf(), kMoreThanQueued));
  ASSERT_TRUE(program.WaitForOutput("\n", kPatience));
  // One line more than the queue holds may be in the writing thread's hands.
  const int dropped = kMoreThanQueued - static_cast<int>(kMaxQueuedLogLines);
  EXPECT_TRUE(program.output() == "dropped " + std::to_string(dropped) + "\n" ||
              program.output() ==
                  "dropped " + std::to_string(dropped - 1) + "\n")
      << program.output();
  program.Signal(SIGUSR1);
  EXPECT_EQ(program.WaitForExit(kPatience), 0) << "it ends all the same";
}

TEST_P(UnreadLog, KeepsTheNewestLinesUntilSomebodyReads) {
  UnreadOutput unread(GetParam());
  ChildProcess program(LogLines(unread.AsStandardErrorOf(), kMoreThanQueued));
  ASSERT_TRUE(program.WaitForOutput("dropped ", kPatience));
  const std::string last = "line " + std::to_string(kMoreThanQueued - 1);
  std::string read;
  const Time end = Clock::now() + kPatience;
  while (read.find(last) == std::string::npos && Clock::now() < end) {
    read += unread.Read(milliseconds(100));
  }
  EXPECT_NE(read.find(last), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Kinds, UnreadLog,
                         ::testing::Values(UnreadOutput::Kind::kPipe,
                                           UnreadOutput::Kind::kTerminal));

TEST(Log, CountsLinesThatStandardErrorRefuses) {
  ChildProcess program(LogLines({"sh", "-c", "exec \"$@\" 2>>/dev/full", "sh"},
                                kMoreThanQueued));
  ASSERT_TRUE(program.WaitForOutput("\n", kPatience));
  const int dropped = std::stoi(program.output().substr(sizeof "dropped"));
  EXPECT_GE(dropped,
            kMoreThanQueued - static_cast<int>(kMaxQueuedLogLines) - 1);
}

}  // namespace
}  // namespace terra::bus

#include "logger/log_rebase.h"

#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace terra::logger {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kGap = 5'000'000;

std::vector<std::int64_t> PutAll(const std::vector<std::int64_t>& times,
                                 std::int64_t jumps) {
  EvenTime line(kGap);
  std::vector<std::int64_t> put;
  for (const std::int64_t time : times) put.push_back(line.Put(time));
  EXPECT_EQ(line.jumps(), jumps);
  return put;
}

TEST(EvenTime, KeepsTimesThatGoOnBySmallSteps) {
  EXPECT_THAT(PutAll({7, 7, 10, 10 + kGap}, 0),
              ElementsAre(7, 7, 10, 10 + kGap));
}

TEST(EvenTime, StandsWhereTheClockRanBack) {
  EXPECT_THAT(PutAll({100, 40, 50}, 1), ElementsAre(100, 100, 110));
}

TEST(EvenTime, ShortensAJumpAhead) {
  EXPECT_THAT(PutAll({0, kGap + 1, kGap + 2}, 1),
              ElementsAre(0, kGap, kGap + 1));
  // A clock that begins in 1970 and is set.
  EXPECT_THAT(PutAll({30'000'000, 1'780'000'000'000'000}, 1),
              ElementsAre(30'000'000, 30'000'000 + kGap));
}

TEST(EvenTime, TakesAnyNumbers) {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(PutAll({kLeast, kMost, kLeast, -5, kMost}, 4),
              ElementsAre(0, kGap, kGap, 2 * kGap, 3 * kGap));
  EXPECT_THAT(PutAll({kMost, 0, 10}, 1),
              ElementsAre(EvenTime::kLatestUs, EvenTime::kLatestUs,
                          EvenTime::kLatestUs));
}

TEST(RebaseLog, WritesEventsAnewWithoutTheRecordersMarks) {
  const std::vector<std::uint8_t> data = {1, 2, 3};
  std::vector<std::uint8_t> log;
  AppendLogEvent(log, {4, 100, "R2_TERRA_LOG", data});
  AppendLogEvent(log, {5, 100, "TERRA_POSE", data});
  AppendLogEvent(log, {6, 90, "TERRA_LOG", data});
  AppendLogEvent(log, {9, 95, "FOREIGN", data});
  LogReader reader(log);
  std::string written;
  const RebasedLog rebased =
      RebaseLog(reader, kGap, [&written](std::string_view bytes) {
        written += bytes;
      });
  EXPECT_EQ(rebased.events, 2);
  EXPECT_EQ(rebased.jumps, 1);
  std::vector<std::uint8_t> expected;
  AppendLogEvent(expected, {0, 100, "TERRA_POSE", data});
  AppendLogEvent(expected, {1, 105, "FOREIGN", data});
  EXPECT_EQ(written, std::string(expected.begin(), expected.end()));
}

}  // namespace
}  // namespace terra::logger

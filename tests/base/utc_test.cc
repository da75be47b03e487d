#include "base/utc.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace terra {
namespace {

constexpr const char* kIso = "%Y-%m-%dT%H:%M:%SZ";

TEST(FormatUtc, KnowsNoTimeZoneOfTheMachine) {
  EXPECT_EQ(FormatUtc(0, kIso), "1970-01-01T00:00:00Z");
  EXPECT_EQ(FormatUtc(1'709'164'799, kIso), "2024-02-28T23:59:59Z");
  EXPECT_EQ(FormatUtc(1'709'164'800, kIso), "2024-02-29T00:00:00Z");
  EXPECT_EQ(FormatUtc(-1, kIso), "1969-12-31T23:59:59Z");
}

TEST(FormatUtc, IsEmptyForWhatNoCalendarHolds) {
  EXPECT_EQ(FormatUtc(std::numeric_limits<std::int64_t>::max(), kIso), "");
}

TEST(UtcNow, IsWrittenAsRecordingsHaveIt) {
  EXPECT_THAT(UtcNow(), ::testing::MatchesRegex("20..-..-..T..:..:..Z"));
}

}  // namespace
}  // namespace terra

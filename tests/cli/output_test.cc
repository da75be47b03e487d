#include "cli/output.h"

#include <gtest/gtest.h>

#include "terrain/legend.h"

namespace terra::cli {
namespace {

TEST(SavingPercentTest, IsOfTheBaselinesCost) {
  EXPECT_EQ(SavingPercent(200, 150), 25);
  EXPECT_EQ(SavingPercent(200, 200), 0);
}

TEST(SavingPercentTest, IsZeroWithNothingToCompareWith) {
  EXPECT_EQ(SavingPercent(0, 0), 0);
  EXPECT_EQ(SavingPercent(kImpassable, 7), 0);
}

}  // namespace
}  // namespace terra::cli

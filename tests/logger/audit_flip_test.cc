// One flipped bit of what a gate heard or said, anywhere in a log.
#include <gtest/gtest.h>

#include "tests/logger/flip_check.h"
#include "tests/support/random_map.h"

namespace terra::logger {
namespace {

TEST(AuditOfAFlippedBit, NoticesItOrTheBitDecidesNothing) {
  FlipCheck check(EventfulRun());
  testing::Random random(1);
  const int places = static_cast<int>(check.places().size());
  constexpr int kFlips = 1'000;
  for (int i = 0; i < kFlips; ++i) {
    const auto place = static_cast<std::size_t>(random.Int(0, places - 1));
    const auto wrong =
        check.WhatIsWrong(check.places()[place], random.Int(0, 7));
    EXPECT_FALSE(wrong) << *wrong;
  }
  // Most of a log matters.
  EXPECT_GT(check.noticed(), kFlips / 2);
}

}  // namespace
}  // namespace terra::logger

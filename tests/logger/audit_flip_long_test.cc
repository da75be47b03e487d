// Every bit of the logs of a few runs, flipped.
#include <iostream>

#include <gtest/gtest.h>

#include "tests/logger/flip_check.h"

namespace terra::logger {
namespace {

void FlipEveryBit(const Messages& run) {
  FlipCheck check(run);
  for (const FlipCheck::Place place : check.places()) {
    for (int bit = 0; bit < 8; ++bit) {
      const auto wrong = check.WhatIsWrong(place, bit);
      EXPECT_FALSE(wrong) << *wrong;
    }
  }
  std::cout << check.places().size() << " bytes, " << check.noticed()
            << " flips noticed, " << check.irrelevant() << " irrelevant\n";
  EXPECT_GT(check.noticed(), check.irrelevant());
}

TEST(AuditOfEveryFlippedBit, OfAnEventfulRunIsNoticedOrDecidesNothing) {
  FlipEveryBit(EventfulRun());
}

TEST(AuditOfEveryFlippedBit, OfARandomRunIsNoticedOrDecidesNothing) {
  FlipEveryBit(RandomRun(7));
}

}  // namespace
}  // namespace terra::logger

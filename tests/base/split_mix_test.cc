#include "base/split_mix.h"

#include <gtest/gtest.h>

namespace terra {
namespace {

// The first numbers of seed 1234567 by its authors' own program.
TEST(SplitMix64, GivesTheNumbersOfItsAuthors) {
  SplitMix64 random(1234567);
  EXPECT_EQ(random.Next(), 6457827717110365317u);
  EXPECT_EQ(random.Next(), 3203168211198807973u);
  EXPECT_EQ(random.Next(), 9817491932198370423u);
  EXPECT_EQ(random.Next(), 4593380528125082431u);
  EXPECT_EQ(random.Next(), 16408922859458223821u);
}

TEST(SplitMix64, SkipsAsIfTheNumbersHadBeenDrawn) {
  SplitMix64 drawn(3);
  SplitMix64 skipped(3);
  for (int i = 0; i < 1'000; ++i) drawn.Next();
  skipped.Skip(1'000);
  EXPECT_EQ(skipped.Next(), drawn.Next());
}

}  // namespace
}  // namespace terra

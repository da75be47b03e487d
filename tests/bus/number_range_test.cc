#include "bus/number_range.h"

#include <gtest/gtest.h>

namespace terra::bus {
namespace {

bool Takes(const std::string& text) {
  CLI::App app;
  double value = 0;
  app.add_option("--margin", value)->check(InRange(0.0, 2.5));
  try {
    app.parse("--margin=" + text);
  } catch (const CLI::ParseError&) {
    return false;
  }
  return true;
}

TEST(InRangeTest, TakesTheEndsAndNothingBeyond) {
  EXPECT_TRUE(Takes("0"));
  EXPECT_TRUE(Takes("2.5"));
  EXPECT_FALSE(Takes("-0.1"));
  EXPECT_FALSE(Takes("2.6"));
}

TEST(InRangeTest, RefusesWhatIsNoFiniteNumber) {
  for (const char* text : {"nan", "-nan", "NAN", "inf", "-inf", "x", "1x"}) {
    EXPECT_FALSE(Takes(text)) << text;
  }
}

}  // namespace
}  // namespace terra::bus

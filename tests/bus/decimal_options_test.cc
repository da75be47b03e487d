#include "bus/decimal_options.h"

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace terra::bus {
namespace {

bool Takes(const std::string& arguments) {
  CLI::App app;
  int stride = 0;
  std::uint64_t seed = 0;
  std::string text;
  app.add_option("--stride", stride)->check(CLI::Range(1, 100));
  CLI::App& command = *app.add_subcommand("run");
  command.add_option("--jobs", stride)->type_name("N");
  command.add_option("--seed", seed);
  command.add_option("--text", text);
  TakeDecimalNumbersOnly(app);
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError&) {
    return false;
  }
  return true;
}

TEST(DecimalOptions, WholeNumbersAreDecimal) {
  for (const char* text : {"--stride 50", "run --jobs 0", "run --jobs -3",
                           "run --seed 18446744073709551615"}) {
    EXPECT_TRUE(Takes(text)) << text;
  }
  for (const char* text :
       {"--stride 050", "--stride 0x20", "run --jobs 010", "run --jobs -010",
        "run --seed -1", "run --seed 007", "run --seed 99999999999999999999"}) {
    EXPECT_FALSE(Takes(text)) << text;
  }
}

TEST(DecimalOptions, TextsStayAsTheyAre) {
  EXPECT_TRUE(Takes("run --text 007"));
}

}  // namespace
}  // namespace terra::bus

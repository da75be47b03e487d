#include "verifier/gate_options.h"

#include <string>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace terra::verifier {
namespace {

TEST(ReadGateOptions, ReadsBackWhatAGatePrints) {
  for (const double margin : {0.0, 0.5, 1e-3, 12345.678}) {
    GateOptions options;
    CLI::App app;
    app.option_defaults()->always_capture_default();
    AddGateOptions(app, options);
    app.parse("--margin=" + std::to_string(margin));
    const auto read = ReadGateOptions(
        "lcm-url=\"udpm://239.255.76.67:7667?ttl=0\"\n"
        "name=\"verifier\"\n" +
        app.config_to_str(true, false) + "robot=\"\"\n");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->margin, options.margin);
    EXPECT_EQ(read->session, 0);
  }
}

TEST(ReadGateOptions, AWordInAnotherValueIsNoMargin) {
  const auto read =
      ReadGateOptions("name=\"margin=7\"\n# margin=8\nmargin = 2.5\n");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->margin, 2.5);
}

TEST(ReadGateOptions, WithoutAMarginItIsTheDefault) {
  const auto read = ReadGateOptions("name=\"verifier\"\n");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->margin, 0);
}

TEST(ReadGateOptions, WhatAGateRefusesIsAnError) {
  for (const char* text : {"margin=much\n", "margin=-1\n", "margin=nan\n",
                           "margin=1,5\n", "margin=\n"}) {
    EXPECT_FALSE(ReadGateOptions(text).ok()) << text;
  }
}

}  // namespace
}  // namespace terra::verifier

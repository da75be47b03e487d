#include "terrain/legend.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"

namespace terra {
namespace {

using ::testing::HasSubstr;

const Terrain kGround = {0, "ground", 1.0, {255, 255, 255}};

struct BadLegend {
  std::string name;
  std::vector<Terrain> terrains;
  std::string message;
};

class BadLegendTest : public ::testing::TestWithParam<BadLegend> {};

TEST_P(BadLegendTest, IsRefusedAndSaysWhy) {
  const auto legend = Legend::Create(GetParam().terrains);
  ASSERT_FALSE(legend.ok());
  EXPECT_THAT(legend.error().message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Legends, BadLegendTest,
    ::testing::Values(
        BadLegend{"Empty", {}, "at least one"},
        BadLegend{"IdTooLarge", {{256, "a", 1, {}}}, "0 to 255"},
        BadLegend{"IdNegative", {{-1, "a", 1, {}}}, "0 to 255"},
        BadLegend{"IdTwice", {kGround, {0, "b", 2, {}}}, "two rows"},
        BadLegend{"ColourTwice",
                  {kGround, {1, "b", 2, {255, 255, 255}}},
                  "colour of another"},
        BadLegend{"CostZero", {{0, "a", 0, {}}}, "cost"},
        BadLegend{"CostNegative", {{0, "a", -1, {}}}, "cost"},
        BadLegend{"CostNotANumber", {{0, "a", 0.0 / 0.0, {}}}, "cost"},
        BadLegend{"CostMinusInfinity", {{0, "a", -kImpassable, {}}}, "cost"},
        BadLegend{"NameTooLong", {{0, std::string(32, 'a'), 1, {}}}, "31"},
        BadLegend{"NameEmpty", {{0, "", 1, {}}}, "31"}),
    [](const auto& tested) {
      return tested.param.name;
    });

TEST(LegendTest, ColourIsFoundExactlyOrNotAtAll) {
  const Legend& legend = MultiTerraPathLegend();
  ASSERT_NE(legend.FindColor({0xFF, 0xA5, 0x00}), nullptr);
  EXPECT_EQ(legend.FindColor({0xFF, 0xA5, 0x00})->id, 7);
  EXPECT_EQ(legend.FindColor({0xFF, 0xA5, 0x01}), nullptr);
}

TEST(LegendTest, BuiltInLegendsAreThere) {
  for (const auto name : BuiltinLegendNames()) {
    EXPECT_NE(FindBuiltinLegend(name), nullptr) << name;
  }
  EXPECT_EQ(FindBuiltinLegend("none such"), nullptr);
  EXPECT_EQ(RugdLegend().terrains().size(), 25u);
}

}  // namespace
}  // namespace terra

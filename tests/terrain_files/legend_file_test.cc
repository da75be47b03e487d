#include "terrain/files/legend_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using ::testing::EndsWith;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

TEST(LegendFile, EveryBuiltinLegendSurvivesWritingAndReading) {
  const TempFolder folder;
  for (const std::string_view name : BuiltinLegendNames()) {
    const Legend& legend = *FindBuiltinLegend(name);
    const std::string path = folder.Path("legend.csv");
    ASSERT_TRUE(WriteLegend(legend, path).ok());
    const auto read = ReadLegend(path);
    ASSERT_TRUE(read.ok()) << ErrorMessage(read);
    EXPECT_EQ(*read, legend);
  }
}

TEST(LegendFile, BuiltinLegendsAreReadByName) {
  EXPECT_EQ(ReadLegend("rugd").value(), RugdLegend());
}

TEST(LegendFile, AnUnknownNameListsTheKnownOnes) {
  EXPECT_THAT(ErrorMessage(ReadLegend("no-such-legend")),
              HasSubstr("multiterrapath, rugd, movingai, occupancy"));
}

struct WrongRow {
  const char* row;
  const char* complaint;
};

class WrongLegendRow : public ::testing::TestWithParam<WrongRow> {};

TEST_P(WrongLegendRow, IsRefusedWithItsLine) {
  const TempFolder folder;
  const std::string path = folder.Write(
      "l.csv",
      std::string("id,name,cost,color\n1,grass,2,#00FF00\n") + GetParam().row);
  const std::string message = ErrorMessage(ReadLegend(path));
  EXPECT_THAT(message, HasSubstr("l.csv:3: "));
  EXPECT_THAT(message, HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Rows, WrongLegendRow,
    ::testing::Values(WrongRow{"x,a,2,#000000", "'x' is not an integer"},
                      WrongRow{"256,a,2,#000000", "ids are 0 to 255"},
                      WrongRow{"-1,a,2,#000000", "ids are 0 to 255"},
                      WrongRow{"1,a,2,#000000", "two rows"},
                      WrongRow{"2,a,,#000000", "'' is not a number"},
                      WrongRow{"2,a,\"1,5\",#000000", "a point: 1.5"},
                      WrongRow{"2,a,1,5,#000000", "a number has a point"},
                      WrongRow{"2,a,5 m,#000000", "not a number"},
                      WrongRow{"2,a,-inf,#000000", "not a number"},
                      WrongRow{"2,a,0,#000000", "neither inf nor within"},
                      WrongRow{"2,a,-1,#000000", "neither inf nor within"},
                      WrongRow{"2,a,nan,#000000", "not a number"},
                      WrongRow{"2,a,2,#00FF00", "colour of another terrain"},
                      WrongRow{"2,a,2,00FF00", "not a colour"},
                      WrongRow{"2,a,2,#00FF0", "not a colour"},
                      WrongRow{"2,a,2,#00FF0G", "not a colour"},
                      WrongRow{"2,,2,#000000", "a name is 1 to 31 bytes"},
                      WrongRow{"2,a,2", "3 fields"}));

TEST(LegendFile, WhatIsUnambiguousIsTaken) {
  const TempFolder folder;
  const auto legend =
      ReadLegend(folder.Write("l.csv",
                              "# of our field\nid, name, Cost, color\n"
                              "1, grass, 2, #00ff00\n#2, sand, 3, #FFFF00\n"
                              "3, rock, Inf, #000000\n"));
  ASSERT_TRUE(legend.ok()) << ErrorMessage(legend);
  ASSERT_EQ(legend->terrains().size(), 2U);
  EXPECT_EQ(legend->terrains()[0].name, "grass");
  EXPECT_EQ(legend->terrains()[1].cost, kImpassable);
}

TEST(LegendFile, ALegendWithoutRowsIsRefused) {
  const TempFolder folder;
  const std::string path = folder.Write("l.csv", "id,name,cost,color\n");
  EXPECT_THAT(ErrorMessage(ReadLegend(path)), HasSubstr("at least one"));
}

TEST(LegendFile, WrongColumnsAreNamed) {
  const TempFolder folder;
  const std::string path = folder.Write("l.csv", "id,name,cost\n");
  EXPECT_THAT(ErrorMessage(ReadLegend(path)),
              EndsWith("no column 'color'; the header must have "
                       "id,name,cost,color"));
}

}  // namespace
}  // namespace terra

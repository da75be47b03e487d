#include "terrain/files/dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "tests/support/error_message.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

constexpr char kHeader[] = "case_id,map,start_x,start_y,goal_x,goal_y\n";

TEST(Dataset, CasesSurviveWritingAndReading) {
  const TempFolder folder;
  const std::vector<DatasetCase> cases = {
      {"a", "maps/a.png", {1, 2}, {3, 4}, "park", {{"sequence", "park-1"}}},
      {"b, c", "maps/b.png", {5, 6}, {7, 8}, "", {{"sequence", ""}}}};
  ASSERT_TRUE(WriteCases(cases, folder.Path("cases.csv")).ok());
  folder.Write("dataset.json", R"({"name": "two", "version": "3"})");
  const auto dataset = ReadDataset(folder.Path(""));
  ASSERT_TRUE(dataset.ok()) << ErrorMessage(dataset);
  EXPECT_EQ(dataset->name, "two");
  EXPECT_EQ(dataset->version, "3");
  ASSERT_EQ(dataset->cases.size(), 2U);
  const DatasetCase* found = dataset->Find("b, c");
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->goal, (Cell{7, 8}));
  EXPECT_EQ(dataset->cases[0].extra.at("sequence"), "park-1");
  EXPECT_EQ(dataset->Find("c"), nullptr);
}

TEST(Dataset, MapsAreReadWithTheFoldersLegend) {
  const TempFolder folder;
  testing::Random random(9);
  const TerrainMap map =
      testing::RandomMap(random, 8, 8, testing::RandomMapKind::kNoise);
  folder.Write("cases.csv", std::string(kHeader) + "a,maps/a.png,0,0,7,7\n");
  folder.Write("maps/a.png", "");
  ASSERT_TRUE(WriteIdPng(map, folder.Path("maps/a.png")).ok());
  const auto dataset = ReadDataset(folder.Path(""));
  ASSERT_TRUE(dataset.ok()) << ErrorMessage(dataset);
  EXPECT_EQ(dataset->legend, MultiTerraPathLegend());
  const auto read = ReadCaseMap(*dataset, dataset->cases[0]);
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_TRUE((read->ids() == map.ids()).all());

  folder.Write("legend.csv", "id,name,cost,color\n200,rock,1,#FFFFFF\n");
  const auto other = ReadDataset(folder.Path(""));
  ASSERT_TRUE(other.ok()) << ErrorMessage(other);
  EXPECT_FALSE(ReadCaseMap(*other, other->cases[0]).ok());
}

struct WrongCases {
  const char* rows;
  const char* complaint;
};

class WrongDataset : public ::testing::TestWithParam<WrongCases> {};

TEST_P(WrongDataset, IsRefusedWithItsLine) {
  const TempFolder folder;
  folder.Write("cases.csv", std::string(kHeader) + GetParam().rows);
  EXPECT_THAT(ErrorMessage(ReadDataset(folder.Path(""))),
              HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, WrongDataset,
    ::testing::Values(
        WrongCases{"a,m.png,0,0,1,1\na,m.png,0,0,1,1\n", "cases.csv:3: "},
        WrongCases{"a,m.png,0,0,x,1\n", "cases.csv:2: goal_x"},
        WrongCases{",m.png,0,0,1,1\n", "empty case_id"},
        WrongCases{"a,/etc/m.png,0,0,1,1\n", "inside the dataset"},
        WrongCases{"a,maps/../../m.png,0,0,1,1\n", "inside the dataset"},
        WrongCases{"a,,0,0,1,1\n", "inside the dataset"}));

TEST(Dataset, AMissingCaseTableAndAWrongJsonAreNamed) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(ReadDataset(folder.Path(""))),
              HasSubstr("cases.csv: there is no such file"));
  folder.Write("cases.csv", kHeader);
  for (const char* json :
       {"{", "[]", "{\"name\": \"\xE4\"}", R"({"name": 3})"}) {
    folder.Write("dataset.json", json);
    const std::string message = ErrorMessage(ReadDataset(folder.Path("")));
    EXPECT_THAT(message, HasSubstr("dataset.json: "));
    EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace terra

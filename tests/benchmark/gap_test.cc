#include "benchmark/gap.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "terrain/files/whole_file.h"
#include "tests/support/ascii_map.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::MapFromAscii;
using terra::testing::TempFolder;

TEST(MeasureGap, ComparesTheLatticeWithTheNativeOptimum) {
  // At stride 4 the lattice is (0,0) (4,0) and the straight row costs 1+9+1+1;
  // natively one goes round the 9 in row 1: sqrt 2 + sqrt 2 + 1 + 1.
  const TerrainMap map = MapFromAscii({"11911",  //
                                       "11111"});
  GapOptions options;
  options.strides = {4};
  const CaseGap gap = MeasureGap(map, {0, 0}, {4, 0}, options);
  ASSERT_EQ(gap.baseline_costs.size(), 1U);
  EXPECT_DOUBLE_EQ(gap.baseline_costs[0], 12);
  EXPECT_DOUBLE_EQ(gap.oracle_cost, 2 + 2 * std::sqrt(2.0));
}

TEST(MeasureGap, IsInfiniteWhereThereIsNoRoute) {
  const TerrainMap map = MapFromAscii({"1#1",  //
                                       "1#1"});
  const CaseGap gap = MeasureGap(map, {0, 0}, {2, 0}, {});
  EXPECT_EQ(gap.oracle_cost, kImpassable);
  EXPECT_THAT(gap.baseline_costs, ::testing::Each(kImpassable));
}

TEST(GapSummaries, CountOnlyComparableCasesAndRealGaps) {
  // Hand-computed: 4 comparable cases of 5; gaps 0.2 and 0.5; a tie and a
  // difference below epsilon are no gaps.
  GapSummaries summaries({50});
  for (const CaseGap& gap : std::vector<CaseGap>{{{10}, 8},
                                                 {{10}, 5},
                                                 {{10}, 10},
                                                 {{10}, 10 - 5e-7},
                                                 {{kImpassable}, 5}}) {
    summaries.Add("easy", gap);
  }
  const std::vector<GapSummary> rows = summaries.Rows();
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].paths, 5);
  EXPECT_EQ(rows[0].comparable, 4);
  EXPECT_EQ(rows[0].gaps, 2);
  EXPECT_DOUBLE_EQ(rows[0].mean_gap, 0.35);
}

class MeasureGapsTest : public ::testing::Test {
 protected:
  // One map of three cells in a row, the last one blocked.
  void WriteCases(const std::string& cases) {
    const TerrainMap map = MapFromAscii({"11#"});
    folder_.Write("legend.csv", "");
    ASSERT_TRUE(WriteLegend(map.legend(), folder_.Path("legend.csv")).ok());
    ASSERT_TRUE(WriteIdPng(map, folder_.Path("m.png")).ok());
    folder_.Write("cases.csv",
                  "case_id,map,start_x,start_y,goal_x,goal_y\n" + cases);
  }

  Result<std::vector<GapSummary>> Measure(std::vector<int> strides) {
    GapOptions options;
    options.strides = std::move(strides);
    return MeasureGaps(OpenDataset(folder_.Path("")).value(), options,
                       folder_.Path("gap.csv"));
  }

  TempFolder folder_;
};

TEST_F(MeasureGapsTest, WriteARowPerCaseAndStrideInOrderOfTheCases) {
  std::string cases;
  std::string rows = "case_id,stride,baseline_cost,oracle_cost\n";
  // Far more than are under way at once.
  for (int i = 0; i < 500; ++i) {
    const std::string id = std::to_string(i);
    cases += id + (i % 3 == 0 ? ",m.png,0,0,2,0\n" : ",m.png,0,0,1,0\n");
    const char* costs = i % 3 == 0 ? ",inf,inf\n" : ",1,1\n";
    rows.append(id).append(",1").append(costs);
    rows.append(id).append(",2").append(costs);
  }
  WriteCases(cases);
  const auto summaries = Measure({1, 2});
  ASSERT_TRUE(summaries.ok()) << ErrorMessage(summaries);
  EXPECT_EQ(summaries->at(1).paths, 500);
  EXPECT_EQ(summaries->at(1).comparable, 333);
  EXPECT_EQ(ReadWholeFile(folder_.Path("gap.csv"), 1 << 20).value(), rows);
}

TEST_F(MeasureGapsTest, AFaultLeavesNoFile) {
  for (const auto& [cases, why] :
       {std::pair<std::string, std::string>{
            "a,m.png,0,0,1,0\na,m.png,0,0,1,0\n",
            "cases.csv:3: case_id 'a' comes"},
        {"a,m.png,0,0,1,0\nb,no.png,0,0,1,0\n", "no.png"}}) {
    WriteCases(cases);
    EXPECT_THAT(ErrorMessage(Measure({1})), ::testing::HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(folder_.Path("gap.csv")));
  }
}

}  // namespace
}  // namespace terra::benchmark

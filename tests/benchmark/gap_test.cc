#include "benchmark/gap.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/files/whole_file.h"
#include "tests/support/ascii_map.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

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

TEST(SummarizeGaps, CountsOnlyComparableCasesAndRealGaps) {
  // Hand-computed: 4 comparable cases of 5; gaps 0.2 and 0.5; a tie and a
  // difference below epsilon are no gaps.
  std::vector<DatasetCase> cases(5);
  for (DatasetCase& c : cases) c.group = "easy";
  const std::vector<CaseGap> gaps = {
      {{10}, 8}, {{10}, 5}, {{10}, 10}, {{10}, 10 - 5e-7}, {{kImpassable}, 5}};
  GapOptions options;
  options.strides = {50};
  const std::vector<GapSummary> rows = SummarizeGaps(cases, gaps, options);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].paths, 5);
  EXPECT_EQ(rows[0].comparable, 4);
  EXPECT_EQ(rows[0].gaps, 2);
  EXPECT_DOUBLE_EQ(rows[0].mean_gap, 0.35);
}

TEST(WriteGaps, HasARowPerCaseAndStride) {
  const TempFolder folder;
  std::vector<DatasetCase> cases(2);
  cases[0].case_id = "a";
  cases[1].case_id = "b";
  GapOptions options;
  options.strides = {10, 20};
  ASSERT_TRUE(WriteGaps(cases, {{{3, 4}, 2.5}, {{kImpassable, 7}, 6}}, options,
                        folder.Path("gap.csv"))
                  .ok());
  EXPECT_EQ(ReadWholeFile(folder.Path("gap.csv"), 1000).value(),
            "case_id,stride,baseline_cost,oracle_cost\n"
            "a,10,3,2.5\na,20,4,2.5\nb,10,inf,6\nb,20,7,6\n");
}

}  // namespace
}  // namespace terra::benchmark

// The 32 maps of tests/data/llm-answers at stride 50: costs as another program
// found them, routes as they were first found here.
#include <string>

#include <gtest/gtest.h>

#include "planner/coarse_lattice.h"
#include "terrain/files/csv.h"
#include "terrain/files/dataset.h"
#include "terrain/native_search.h"
#include "terrain/route_text.h"
#include "tests/planner/eager_lattice.h"

namespace terra::planner {
namespace {

const std::string kFolder = TERRA_TEST_DATA "/llm-answers";

// The cell of a table in the row of a case.
std::string Field(const CsvTable& table, const std::string& case_id,
                  std::string_view column) {
  for (const CsvRow& row : table.rows) {
    if (row.fields[0] == case_id) {
      return row.fields[static_cast<std::size_t>(table.Column(column))];
    }
  }
  return "";
}

TEST(RecordedCasesTest, BaselineAndOptimumCostWhatAnotherProgramFound) {
  const Dataset dataset = ReadDataset(kFolder).value();
  const CsvTable costs =
      ReadCsv(kFolder + "/costs.csv", {"case_id", "base", "oracle"}).value();
  ASSERT_EQ(dataset.cases.size(), 32U);
  for (const DatasetCase& c : dataset.cases) {
    const TerrainMap map = ReadCaseMap(dataset, c).value();
    const LatticePlan plan = PlanOnLattice(map, c.start, c.goal);
    EXPECT_NEAR(plan.cost, ParseNumber(Field(costs, c.case_id, "base")).value(),
                1e-8)
        << c.case_id;
    EXPECT_NEAR(NativeSearch(map, c.start, c.goal).cost,
                ParseNumber(Field(costs, c.case_id, "oracle")).value(), 1e-8)
        << c.case_id;
  }
}

TEST(RecordedCasesTest, BaselineRoutesAreTheGoldenOnes) {
  const Dataset dataset = ReadDataset(kFolder).value();
  const CsvTable golden =
      ReadCsv(TERRA_GOLDEN_ROUTES, {"case_id", "route"}).value();
  ASSERT_EQ(golden.rows.size(), dataset.cases.size());
  for (const DatasetCase& c : dataset.cases) {
    const TerrainMap map = ReadCaseMap(dataset, c).value();
    const LatticePlan plan = PlanOnLattice(map, c.start, c.goal);
    EXPECT_EQ(FormatRoute(plan.waypoints), Field(golden, c.case_id, "route"))
        << c.case_id;
    EXPECT_EQ(plan.waypoints,
              testing::PlanEagerly(map, c.start, c.goal, {}).waypoints)
        << c.case_id;
  }
}

}  // namespace
}  // namespace terra::planner

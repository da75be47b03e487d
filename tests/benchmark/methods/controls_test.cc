// The methods that need no model, on the 32 maps of tests/data/llm-answers: the
// rows of its README, which another program computed.
#include "benchmark/methods/controls.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "benchmark/methods/comparison_refiners.h"
#include "planner/coarse_lattice.h"
#include "terrain/files/dataset.h"
#include "terrain/native_search.h"

namespace terra::benchmark {
namespace {

constexpr double kEpsilon = 1e-6;

// Percentages as in the README.
struct Row {
  double fir = 0;        // Made cheaper, of all cases.
  double isr = 0;        // Invalid, of all cases.
  double acr = 0;        // Mean saving where made cheaper.
  double recovered = 0;  // Mean share of the gap, where there is one.
};

Row Score(const std::function<RefineOutput(const RefineInput&)>& method) {
  const Dataset dataset = ReadDataset(TERRA_TEST_DATA "/llm-answers").value();
  int cheaper = 0;
  int invalid = 0;
  int with_gap = 0;
  Row row;
  for (const DatasetCase& c : dataset.cases) {
    const TerrainMap map = ReadCaseMap(dataset, c).value();
    const planner::LatticePlan plan =
        planner::PlanOnLattice(map, c.start, c.goal);
    const double oracle = NativeSearch(map, c.start, c.goal).cost;
    const RefineOutput output = method({map, plan.waypoints, plan.cost});
    const double saving = std::max(0.0, plan.cost - output.cost);
    invalid += output.cost == kImpassable ? 1 : 0;
    if (output.cost < plan.cost - kEpsilon) {
      ++cheaper;
      row.acr += 100 * saving / plan.cost;
    }
    if (oracle < plan.cost - kEpsilon) {
      ++with_gap;
      row.recovered += 100 * saving / (plan.cost - oracle);
    }
  }
  const auto cases = static_cast<double>(dataset.cases.size());
  row.fir = 100 * cheaper / cases;
  row.isr = 100 * invalid / cases;
  row.acr /= cheaper;
  row.recovered /= with_gap;
  return row;
}

void ExpectRow(const Row& got, const Row& want) {
  constexpr double kPrinted = 0.00501;  // Two decimals.
  EXPECT_NEAR(got.fir, want.fir, kPrinted);
  EXPECT_NEAR(got.isr, want.isr, kPrinted);
  EXPECT_NEAR(got.acr, want.acr, kPrinted);
  EXPECT_NEAR(got.recovered, want.recovered, kPrinted);
}

TEST(ControlsTest, CorridorAroundTheBaselineScoresAsRecorded) {
  ExpectRow(Score([](const RefineInput& input) {
              return RefineByBand(input);
            }),
            {87.50, 0, 9.86, 86.97});
}

TEST(ControlsTest, BlindDetoursScoreAsRecorded) {
  ExpectRow(Score(RefineByBlindDetours), {87.50, 0, 12.34, 96.33});
}

TEST(ControlsTest, StraightLineScoresAsRecorded) {
  ExpectRow(Score(StraightLine), {9.38, 37.50, 2.44, 2.70});
}

}  // namespace
}  // namespace terra::benchmark

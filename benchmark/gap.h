#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "planner/coarse_lattice.h"
#include "terrain/cell.h"
#include "terrain/files/dataset.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::benchmark {

struct GapOptions {
  std::vector<int> strides{10, 20, 50, 100};
  planner::JointRule joints = planner::JointRule::kTwoStrides;
  CostModel cost_model;
  int jobs = 0;  ///< 0 = all cores.
};

/// What the lattice costs at each stride, beside the native optimum. Costs are
/// kImpassable where there is no route (or an end is blocked or outside).
struct CaseGap {
  std::vector<double> baseline_costs;  ///< In order of the strides.
  double oracle_cost = kImpassable;
};
CaseGap MeasureGap(const TerrainMap& map, Cell start, Cell goal,
                   const GapOptions& options);

/// Cost of the native optimum; `known_cost` is that of a route that exists, or
/// kImpassable, and saves work.
double OptimalCost(const TerrainMap& map, Cell start, Cell goal,
                   double known_cost);

/// A row of the paper's oracle-gap table, without MOGR.
struct GapSummary {
  std::string group;
  int stride = 0;
  std::int64_t paths = 0;
  std::int64_t comparable = 0;  ///< Baseline and oracle exist.
  std::int64_t gaps = 0;        ///< Baseline > oracle + epsilon.
  double mean_gap = 0;          ///< Of the gaps, relative to the baseline.
};

/// Sums up cases one by one.
class GapSummaries {
 public:
  explicit GapSummaries(std::vector<int> strides)
      : strides_(std::move(strides)) {}

  void Add(const std::string& group, const CaseGap& gap);
  /// A row for each group and stride, in order of appearance.
  std::vector<GapSummary> Rows() const;

 private:
  GapSummary& RowOf(const std::string& group, int stride);

  std::vector<int> strides_;
  std::vector<GapSummary> sums_;  ///< mean_gap is a sum here.
};

/// Measures every case of a dataset and writes case_id, stride, baseline_cost,
/// oracle_cost, in its order. Memory does not grow with the cases.
/// Errors: those of CheckCases; a map that cannot be read; not writable.
Result<std::vector<GapSummary>> MeasureGaps(const DatasetFolder& dataset,
                                            const GapOptions& options,
                                            const std::string& path);

}  // namespace terra::benchmark

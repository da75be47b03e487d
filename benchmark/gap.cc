#include "benchmark/gap.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <utility>

#include "benchmark/parallel.h"
#include "benchmark/progress.h"
#include "terrain/files/csv.h"
#include "terrain/native_search.h"
#include "terrain/require.h"
#include "verifier/verify.h"

namespace terra::benchmark {

namespace fs = std::filesystem;

CaseGap MeasureGap(const TerrainMap& map, Cell start, Cell goal,
                   const GapOptions& options) {
  CaseGap gap;
  double bound = kImpassable;
  for (const int stride : options.strides) {
    planner::LatticeOptions lattice;
    lattice.stride = stride;
    lattice.joints = options.joints;
    const double cost = planner::PlanOnLattice(map, start, goal, lattice).cost;
    gap.baseline_costs.push_back(cost);
    bound = std::min(bound, cost);
  }
  gap.oracle_cost = OptimalCost(map, start, goal, bound);
  return gap;
}

double OptimalCost(const TerrainMap& map, Cell start, Cell goal,
                   double known_cost) {
  // Where costs are no exact units the same route may sum up to a hair more.
  constexpr double kSlack = 1 + 1e-9;
  NativeSearchOptions search;
  search.upper_bound = known_cost * kSlack;
  return NativeSearch(map, start, goal, search).cost;
}

Result<std::vector<CaseGap>> MeasureGaps(const Dataset& dataset,
                                         const GapOptions& options) {
  const auto count = static_cast<std::int64_t>(dataset.cases.size());
  std::vector<CaseGap> gaps(dataset.cases.size());
  std::optional<Error> failure;
  std::mutex mutex;
  Progress progress("gap", count);
  ParallelFor(count, options.jobs, [&](std::int64_t i) {
    const auto index = static_cast<std::size_t>(i);
    const DatasetCase& c = dataset.cases[index];
    const Result<TerrainMap> map = ReadCaseMap(dataset, c, options.cost_model);
    if (map.ok()) {
      gaps[index] = MeasureGap(*map, c.start, c.goal, options);
    } else {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = map.error();
    }
    progress.Advance();
  });
  if (failure) return *failure;
  return gaps;
}

std::vector<GapSummary> SummarizeGaps(const std::vector<DatasetCase>& cases,
                                      const std::vector<CaseGap>& gaps,
                                      const GapOptions& options) {
  TERRA_REQUIRE(cases.size() == gaps.size());
  std::vector<GapSummary> summaries;
  const auto row_of = [&](const std::string& group, int stride) -> GapSummary& {
    for (GapSummary& summary : summaries) {
      if (summary.group == group && summary.stride == stride) return summary;
    }
    return summaries.emplace_back(GapSummary{group, stride, 0, 0, 0, 0});
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t k = 0; k < options.strides.size(); ++k) {
      GapSummary& row = row_of(cases[i].group, options.strides[k]);
      const double baseline = gaps[i].baseline_costs[k];
      const double oracle = gaps[i].oracle_cost;
      ++row.paths;
      if (baseline == kImpassable || oracle == kImpassable) continue;
      ++row.comparable;
      if (!verifier::StrictlyCheaper(oracle, baseline)) continue;
      ++row.gaps;
      row.mean_gap += (baseline - oracle) / baseline;  // A sum, for now.
    }
  }
  for (GapSummary& row : summaries) {
    if (row.gaps > 0) row.mean_gap /= static_cast<double>(row.gaps);
  }
  return summaries;
}

Status WriteGaps(const std::vector<DatasetCase>& cases,
                 const std::vector<CaseGap>& gaps, const GapOptions& options,
                 const std::string& path) {
  TERRA_REQUIRE(cases.size() == gaps.size());
  // A part of the text at a time: there may be a million cases.
  constexpr std::size_t kPartBytes = std::size_t{1} << 16;
  const std::string unfinished = path + ".part";
  std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
  std::string text =
      CsvLine({"case_id", "stride", "baseline_cost", "oracle_cost"});
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t k = 0; k < options.strides.size(); ++k) {
      text += CsvLine({cases[i].case_id, std::to_string(options.strides[k]),
                       FormatNumber(gaps[i].baseline_costs[k]),
                       FormatNumber(gaps[i].oracle_cost)});
    }
    if (text.size() < kPartBytes) continue;
    file << text;
    text.clear();
  }
  file << text;
  file.close();
  std::error_code failed;
  if (file) fs::rename(unfinished, path, failed);
  if (file && !failed) return Done{};
  return Error{ErrorCode::kUnavailable, path + ": cannot be written"};
}

}  // namespace terra::benchmark

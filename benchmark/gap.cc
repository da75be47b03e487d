#include "benchmark/gap.h"

#include <algorithm>
#include <utility>

#include "benchmark/ordered_pipeline.h"
#include "benchmark/progress.h"
#include "output/output_file.h"
#include "terrain/files/case_reader.h"
#include "terrain/files/csv.h"
#include "terrain/native_search.h"
#include "verifier/verify.h"

namespace terra::benchmark {
namespace {

// What is kept of a case until its rows are written.
struct MeasuredCase {
  std::string case_id;
  std::string group;
  CaseGap gap;
};

Result<MeasuredCase> Measure(const DatasetFolder& dataset, const DatasetCase& c,
                             const GapOptions& options) {
  const Result<TerrainMap> map = ReadCaseMap(dataset, c, options.cost_model);
  if (!map.ok()) return map.error();
  return MeasuredCase{c.case_id, c.group,
                      MeasureGap(*map, c.start, c.goal, options)};
}

std::string RowsOf(const MeasuredCase& c, const std::vector<int>& strides) {
  std::string rows;
  for (std::size_t k = 0; k < strides.size(); ++k) {
    rows += CsvLine({c.case_id, std::to_string(strides[k]),
                     FormatNumber(c.gap.baseline_costs[k]),
                     FormatNumber(c.gap.oracle_cost)});
  }
  return rows;
}

}  // namespace

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

void GapSummaries::Add(const std::string& group, const CaseGap& gap) {
  for (std::size_t k = 0; k < strides_.size(); ++k) {
    GapSummary& row = RowOf(group, strides_[k]);
    const double baseline = gap.baseline_costs[k];
    ++row.paths;
    if (baseline == kImpassable || gap.oracle_cost == kImpassable) continue;
    ++row.comparable;
    if (!verifier::StrictlyCheaper(gap.oracle_cost, baseline)) continue;
    ++row.gaps;
    row.mean_gap += (baseline - gap.oracle_cost) / baseline;
  }
}

std::vector<GapSummary> GapSummaries::Rows() const {
  std::vector<GapSummary> rows = sums_;
  for (GapSummary& row : rows) {
    if (row.gaps > 0) row.mean_gap /= static_cast<double>(row.gaps);
  }
  return rows;
}

GapSummary& GapSummaries::RowOf(const std::string& group, int stride) {
  for (GapSummary& row : sums_) {
    if (row.group == group && row.stride == stride) return row;
  }
  return sums_.emplace_back(GapSummary{group, stride, 0, 0, 0, 0});
}

Result<std::vector<GapSummary>> MeasureGaps(const DatasetFolder& dataset,
                                            const GapOptions& options,
                                            const std::string& path) {
  std::int64_t total = 0;
  const Status checked = CheckCases(dataset.folder, [&](const DatasetCase&) {
    ++total;
  });
  if (!checked.ok()) return checked.error();
  Result<CaseReader> cases = CaseReader::Open(dataset.folder);
  if (!cases.ok()) return cases.error();
  Progress progress("gap", total);
  GapSummaries summaries(options.strides);
  Result<OutputFile> file = OutputFile::Create(path);
  if (!file.ok()) return file.error();
  file->Write(CsvLine({"case_id", "stride", "baseline_cost", "oracle_cost"}));
  OrderedPipeline<DatasetCase, MeasuredCase> work(
      [&] {
        return cases->Next();
      },
      [&](const DatasetCase& c) {
        return Measure(dataset, c, options);
      },
      [&](const MeasuredCase& c) -> Status {
        progress.Advance();
        summaries.Add(c.group, c.gap);
        file->Write(RowsOf(c, options.strides));
        return file->status();
      });
  const Status measured = work.Run(options.jobs);
  if (!measured.ok()) return measured.error();
  const Status written = file->Finish();
  if (!written.ok()) return written.error();
  return summaries.Rows();
}

}  // namespace terra::benchmark

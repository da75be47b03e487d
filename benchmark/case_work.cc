#include "benchmark/case_work.h"

#include <utility>

#include "benchmark/gap.h"
#include "benchmark/stopwatch.h"
#include "terrain/digest.h"

namespace terra::benchmark {
namespace {

// The row of a case that has no baseline.
CaseResult WithoutBaseline(const CaseWork& work, int repeat) {
  CaseResult result;
  result.case_id = work.dataset_case.case_id;
  result.group = work.dataset_case.group;
  const auto sequence = work.dataset_case.extra.find("sequence");
  if (sequence != work.dataset_case.extra.end()) {
    result.sequence = sequence->second;
  }
  result.map_id = work.map_id;
  result.repeat = repeat;
  result.kind = AttemptKind::kNoBaseline;
  result.oracle_cost = work.oracle_cost;
  return result;
}

}  // namespace

Result<CaseWork> BeginCase(const DatasetFolder& dataset, const DatasetCase& c,
                           const RunOptions& options) {
  const Stopwatch map_watch;
  Result<TerrainMap> map = ReadCaseMap(dataset, c, options.cost_model);
  if (!map.ok()) return map.error();
  const double t_map = map_watch.Seconds();
  const Stopwatch plan_watch;
  planner::LatticePlan baseline =
      planner::PlanOnLattice(*map, c.start, c.goal, options.lattice);
  const double t_baseline = plan_watch.Seconds();
  const double oracle = OptimalCost(*map, c.start, c.goal, baseline.cost);
  const std::int64_t map_id = MapId(*map);
  return CaseWork{c,     *std::move(map),     map_id,
                  t_map, std::move(baseline), t_baseline,
                  oracle};
}

TriedCase TryCase(const CaseWork& work, const MethodInfo& info, Method& method,
                  int repeat) {
  if (!work.baseline.found()) return {WithoutBaseline(work, repeat), "", ""};
  const MethodInput input{work.dataset_case, work.map, work.map_id,
                          work.baseline, repeat};
  Attempt attempt = method.Try(input);
  const Stopwatch watch;
  CaseResult result = ScoreAttempt(input, info, work.oracle_cost, attempt);
  result.t_det += watch.Seconds();
  result.t_prep += work.t_map;
  if (info.uses_baseline) result.t_det += work.t_baseline;
  return {std::move(result), std::move(attempt.model),
          std::move(attempt.recorded_at)};
}

}  // namespace terra::benchmark

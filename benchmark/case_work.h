#pragma once

#include <string>

#include "benchmark/method.h"
#include "benchmark/run.h"

namespace terra::benchmark {

/// What all methods share of a case: map, baseline and optimum, made once.
struct CaseWork {
  const DatasetCase& dataset_case;
  TerrainMap map;
  std::int64_t map_id = 0;
  double t_map = 0;  ///< Seconds.
  planner::LatticePlan baseline;
  double t_baseline = 0;
  double oracle_cost = kImpassable;
};

/// Errors: a map that cannot be read.
Result<CaseWork> BeginCase(const DatasetFolder& dataset, const DatasetCase& c,
                           const RunOptions& options);

/// A row of results.csv and what run.json collects beside it.
struct TriedCase {
  CaseResult result;
  std::string model;        ///< As the reply named it.
  std::string recorded_at;  ///< UTC of a replayed call.
};

/// Lets a method try a case and scores what it gives; without a baseline there
/// is nothing to try.
TriedCase TryCase(const CaseWork& work, const MethodInfo& info, Method& method,
                  int repeat);

}  // namespace terra::benchmark

#pragma once

#include <vector>

#include "benchmark/loaded_run.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Which run stands in which table of the report. A run that was made twice
/// (same configuration) stands once in a table: the one that took one case at a
/// time, whose FPS means something, else the first.
struct Selection {
  /// The largest set of plain runs on generated maps at the paper's stride that
  /// can stand together.
  std::vector<LoadedRun> comparison;
  std::vector<LoadedRun> gap;     ///< The same cases at all strides.
  std::vector<LoadedRun> joints;  ///< The same cases with all joint rules.
  std::vector<LoadedRun> rugd;
  /// Runs that took one case at a time, on the cases that all of them have.
  std::vector<LoadedRun> latency;
  std::vector<LoadedRun> ablation;  ///< Of a model, without noise.
  /// Of a model with all switches on, on the cases that all of them have.
  std::vector<LoadedRun> noise;
  /// Sets of comparable runs that stand in no table above.
  std::vector<std::vector<LoadedRun>> others;
};

/// Errors: a run that can no longer be read.
Result<Selection> SelectRuns(const std::vector<LoadedRun>& runs);

/// Puts runs into the order of rows: baseline, models, refiners, methods whose
/// route stands as returned, controls, then what no method passes.
void SortRows(std::vector<LoadedRun>& runs);

}  // namespace terra::benchmark

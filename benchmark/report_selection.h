#pragma once

#include <vector>

#include "benchmark/loaded_run.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Which run stands in which table of the report. A run that was made twice
/// (SameRow) stands once in a table: a complete one, and of these the one that
/// took one case at a time, whose FPS means something; else the first.
struct Selection {
  /// The largest set of plain runs on generated maps at the paper's stride that
  /// can stand together.
  std::vector<LoadedRun> comparison;
  /// The same, the control without a model first: gains mean something beside
  /// it.
  std::vector<LoadedRun> paired;
  std::vector<LoadedRun> gap;     ///< The same cases at all strides.
  std::vector<LoadedRun> joints;  ///< The same cases with all joint rules.
  std::vector<LoadedRun> rugd;
  /// Runs that took one case at a time, on the cases that all of them have.
  std::vector<LoadedRun> latency;
  /// Of a model, without noise and with no setting beyond the paper's.
  std::vector<LoadedRun> ablation;
  /// Of a model with all switches on and no setting beyond the paper's, on the
  /// cases that all of them have.
  std::vector<LoadedRun> noise;
  std::vector<LoadedRun> all;
  /// Sets of comparable runs that stand in no table above.
  std::vector<std::vector<LoadedRun>> others;
};

/// Whether every table takes the cases that all its runs have, instead of runs
/// with the same list of cases.
enum class CaseLists { kSame, kCommon };

/// Errors: a run that can no longer be read.
Result<Selection> SelectRuns(const std::vector<LoadedRun>& runs,
                             CaseLists lists = CaseLists::kSame);

/// The runs without those made twice, as Selection.
std::vector<LoadedRun> WithoutDoubles(const std::vector<LoadedRun>& runs);

/// Puts runs into the order of rows: baseline, models, refiners, methods whose
/// route stands as returned, controls, then what no method passes.
void SortRows(std::vector<LoadedRun>& runs);

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/metrics.h"
#include "benchmark/run_description.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A run on disk: its run.json and the scores of its results.csv, in order of
/// the file.
struct LoadedRun {
  std::string folder;
  RunDescription description;
  std::vector<Score> scores;

  /// All cases are there and have an answer.
  bool complete() const;
  std::int64_t num_unanswered() const;
};

/// Reads runs; a folder without run.json stands for all runs below it.
/// Errors: name the file; no run found.
Result<std::vector<LoadedRun>> LoadRuns(
    const std::vector<std::string>& folders);

/// The runs below these folders, in order of their paths.
Result<std::vector<std::string>> FindRuns(
    const std::vector<std::string>& folders);

/// Why two runs cannot stand in one table; empty = they can. They need the same
/// dataset, case list, stride, joints and cost model, and for each case the
/// same map and baseline.
std::string WhyNotComparable(const LoadedRun& a, const LoadedRun& b);

/// Only the cases that all runs have, for `--intersect`.
void KeepCommonCases(std::vector<LoadedRun>& runs);

/// The scores of one group.
std::vector<Score> ScoresOfGroup(const LoadedRun& run,
                                 const std::string& group);

/// The groups of a run, in order of appearance.
std::vector<std::string> GroupsOf(const LoadedRun& run);

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/metrics.h"
#include "benchmark/run_description.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// What the cases of one group come to.
struct GroupFigures {
  std::string group;
  Metrics metrics;
  RepeatFigures repeats;  ///< Zero for runs that ask once.
};

/// A run on disk: its run.json, and what its results.csv comes to. The rows
/// stay on disk, so that many runs of any length can be looked at together.
struct LoadedRun {
  std::string folder;
  RunDescription description;
  ScoreReader read;  ///< The scores, in order of the file.

  // By SumUp.
  std::int64_t num_rows = 0;
  std::int64_t num_unanswered = 0;
  /// Of id, map and baseline of all rows in their order: the same in runs that
  /// can stand in one table, where none lacks a row.
  std::uint64_t cases_digest = 0;
  std::vector<GroupFigures> groups;  ///< In order of appearance.

  /// All cases are there and have an answer.
  bool complete() const;
};

/// Works out the figures of a run from its scores. Of more cases than `at_once`
/// times, intervals of means and figures of repeats are those of a sample of at
/// least half as many, chosen by the cases' keys. Errors: those of `read`.
Status SumUp(LoadedRun& run, std::int64_t at_once = kMaxCasesKept);

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

/// Only the cases that all runs have, for `--intersect`. Errors: those of the
/// runs' readers.
Status KeepCommonCases(std::vector<LoadedRun>& runs);

/// The scores of one group.
ScoreReader ReaderOfGroup(const LoadedRun& run, const std::string& group);

/// The groups of a run, in order of appearance.
std::vector<std::string> GroupsOf(const LoadedRun& run);

/// What a group of a run comes to; nothing where it has no such group.
const GroupFigures& FiguresOf(const LoadedRun& run, const std::string& group);
const Metrics& MetricsOf(const LoadedRun& run, const std::string& group);

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <optional>
#include <set>
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

/// Reads runs; a folder without run.json stands for all runs below it. What is
/// found below and has a run.json of something else is passed over: `others`
/// then gets why, a sentence each.
/// Errors: name the file; no run found; a folder that cannot be looked into.
Result<std::vector<LoadedRun>> LoadRuns(
    const std::vector<std::string>& folders,
    std::vector<std::string>* others = nullptr);

/// Is it a run's own folder: does it hold a run.json?
bool IsRunFolder(const std::string& folder);

/// The runs below these folders, in order of their paths. Hidden folders (a
/// leading dot) and what is no folder are passed over.
Result<std::vector<std::string>> FindRuns(
    const std::vector<std::string>& folders);

/// What rows of one table must have alike.
enum class Shared {
  kDataset,
  kCaseList,
  kStride,
  kJoints,
  kCostModel,
  kBaselines,  ///< Map and baseline of each case that both have.
};

/// Why two runs cannot stand in one table.
struct Mismatch {
  Shared what;       ///< The first that they do not share.
  std::string text;  ///< The same for people, with both folders.
};

/// The first mismatch of two runs beside what the table may vary; none = they
/// can stand in one table. Where stride or joints vary, so do the baselines.
/// Errors: those of the runs' readers.
Result<std::optional<Mismatch>> FindMismatch(
    const LoadedRun& a, const LoadedRun& b,
    const std::set<Shared>& varies = {});

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

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "benchmark/method.h"
#include "planner/coarse_lattice.h"
#include "terrain/files/dataset.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Which of N equal parts of the cases: every N-th from the index-th on.
struct Shard {
  int index = 1;  ///< From 1.
  int count = 1;
};

/// What all methods of a run share.
struct RunOptions {
  planner::LatticeOptions lattice;
  CostModel cost_model;
  /// Case ids, in order of the dataset; empty = all.
  std::vector<std::string> cases;
  int repeats = 1;
  Shard shard;
  int jobs = 0;  ///< 0 = all cores.
};

/// One method of a run and where its results go.
struct MethodRun {
  MethodChoice choice;
  std::string folder;
  /// What else decides its answers (model, prompt, switches): part of the
  /// configuration in run.json, and must be the same when it is resumed.
  std::string settings_json = "{}";
};

/// Who ran it; for run.json.
struct RunOrigin {
  std::string build_id;
  std::string command_line;
};

/// Runs methods over the cases of a dataset. Each method's folder gets
/// results.csv (a row per case and repeat) and run.json.
///
/// A run that was killed at any moment goes on where it stopped: a row is
/// written whole or not at all, finished cases are not run again, those without
/// an answer are. At the end the rows are put into order of the cases.
/// Map, baseline and oracle of a case are made once for all methods.
///
/// Errors: a folder that holds another run or is being written by another
/// process; a map that cannot be read; a method that cannot be made.
Status RunMethods(const Dataset& dataset, const RunOptions& options,
                  const std::vector<MethodRun>& runs, const RunOrigin& origin);

/// Returns the ids of the first n cases of each group.
std::vector<std::string> FirstOfEachGroup(const Dataset& dataset, int n);

/// What identifies a dataset: its own digest, else one of its tables.
Result<std::string> DatasetDigest(const Dataset& dataset);

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "benchmark/case_list.h"
#include "benchmark/method.h"
#include "planner/coarse_lattice.h"
#include "terrain/files/dataset.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// What all methods of a run share.
struct RunOptions {
  planner::LatticeOptions lattice;
  CostModel cost_model;
  CaseSelection cases;
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

/// What progress lines call these runs: "run advisor search, coarse".
std::string ProgressTitle(const std::vector<MethodRun>& runs);

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
/// an answer are. Rows are written in order of the cases; a case that was done
/// before its turn came is among those that a kill makes run again.
/// Map, baseline and oracle of a case are made once for all methods. Memory
/// does not grow with the cases, but for one bit of each.
///
/// Errors: a folder that holds another run or is being written by another
/// process; a map that cannot be read; a method that cannot be made.
Status RunMethods(const DatasetFolder& dataset, const RunOptions& options,
                  const std::vector<MethodRun>& runs, const RunOrigin& origin);

}  // namespace terra::benchmark

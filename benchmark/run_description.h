#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "benchmark/metrics.h"
#include "benchmark/run.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// When replayed calls were made: UTC times of the first and the last; empty
/// where there are none.
struct RecordedTimes {
  std::string first;
  std::string last;

  void Add(const std::string& utc);
  void Add(const RecordedTimes& other);
  /// "2026-01-31" or "2026-01-31 to 2026-02-02".
  std::string Days() const;
};

/// What run.json says of a run, as tables and reports need it.
struct RunDescription {
  static constexpr int kSchema = 1;

  // Decides the figures; the same when a run is resumed or merged.
  std::string method;
  std::string backend;
  std::string title;
  CountingRule rule;
  bool asks_model = false;
  std::string dataset_name;
  std::string dataset_version;
  std::string dataset_digest;
  std::string case_list_digest;
  std::int64_t num_cases = 0;  ///< Of the list, all shards together.
  int stride = 0;
  std::string joints;
  bool corner_cutting = true;
  int clearance_cells = 0;
  int repeats = 1;
  std::string settings_json;  ///< Model, prompt, switches; an object.
  /// Answers came from a simulation or scripted server, no real model.
  bool simulated = false;

  // How this part of it came about.
  Shard shard;
  int jobs = 1;  ///< The most of all starts and shards, side by side.
  std::string build_id;
  std::string command_line;
  std::string machine;
  std::vector<std::string> started;  ///< UTC; one per start.
  std::string finished;              ///< UTC; empty while it runs.
  std::vector<std::string> models;   ///< As the replies named them.
  RecordedTimes recorded;            ///< Replay only.

  /// Has it the same configuration, in all that decides figures (RunFields)?
  /// How it came about and who answered do not count.
  bool SameFigures(const RunDescription& other) const;
  /// Has a title of its own nothing to say beside the other's: the same
  /// figures, answered by the same models, recorded on the same days?
  bool SameRow(const RunDescription& other) const;
};

RunDescription DescribeRun(const DatasetFolder& dataset,
                           const CaseSurvey& survey, const RunOptions& options,
                           const MethodRun& run, const RunOrigin& origin);

/// What run.json has under "configuration".
nlohmann::ordered_json ConfigurationJson(const RunDescription& description);

Status WriteRunDescription(const RunDescription& description,
                           const std::string& path);
/// Errors: name the file. kUnsupported: another schema, or some other program's
/// file; kInvalid also where the configuration has a field that this program
/// does not know.
Result<RunDescription> ReadRunDescription(const std::string& path);

/// "2r", "cell" or "visible".
std::string JointsName(planner::JointRule joints);

}  // namespace terra::benchmark

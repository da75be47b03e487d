#include "benchmark/run_description.h"

#include <fstream>
#include <thread>

#include <nlohmann/json.hpp>
#include <sys/utsname.h>

#include "advisor/wire_json.h"
#include "base/utc.h"
#include "benchmark/parallel.h"
#include "benchmark/run_fields.h"
#include "output/output_file.h"
#include "terrain/files/whole_file.h"

namespace terra::benchmark {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kMaxRunJsonBytes = std::size_t{1} << 20;

std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown processor";
}

std::string MachineText() {
  utsname system{};
  ::uname(&system);
  return ProcessorName() + ", " +
         std::to_string(std::thread::hardware_concurrency()) + " cores, " +
         system.sysname + " " + system.release;
}

}  // namespace

ordered_json ConfigurationJson(const RunDescription& d) {
  return {{"method", d.method},
          {"backend", d.backend},
          {"title", d.title},
          {"fallback", d.rule.fallback},
          {"every_case_attempts", d.rule.every_case_attempts},
          {"asks_model", d.asks_model},
          {"simulated", d.simulated},
          {"dataset",
           {{"name", d.dataset_name},
            {"version", d.dataset_version},
            {"digest", d.dataset_digest}}},
          {"case_list_digest", d.case_list_digest},
          {"cases", d.num_cases},
          {"stride", d.stride},
          {"joints", d.joints},
          {"cost_model",
           {{"corner_cutting", d.corner_cutting},
            {"clearance_cells", d.clearance_cells}}},
          {"repeats", d.repeats},
          {"settings", ordered_json::parse(d.settings_json)}};
}

namespace {

void ReadConfiguration(const ordered_json& c, RunDescription& d) {
  c.at("method").get_to(d.method);
  c.at("backend").get_to(d.backend);
  c.at("title").get_to(d.title);
  c.at("fallback").get_to(d.rule.fallback);
  c.at("every_case_attempts").get_to(d.rule.every_case_attempts);
  c.at("asks_model").get_to(d.asks_model);
  c.at("simulated").get_to(d.simulated);
  c.at("dataset").at("name").get_to(d.dataset_name);
  c.at("dataset").at("version").get_to(d.dataset_version);
  c.at("dataset").at("digest").get_to(d.dataset_digest);
  c.at("case_list_digest").get_to(d.case_list_digest);
  d.num_cases = advisor::IntegerAt<std::int64_t>(c, "cases");
  d.stride = advisor::IntegerAt<int>(c, "stride");
  c.at("joints").get_to(d.joints);
  c.at("cost_model").at("corner_cutting").get_to(d.corner_cutting);
  d.clearance_cells =
      advisor::IntegerAt<int>(c.at("cost_model"), "clearance_cells");
  d.repeats = advisor::IntegerAt<int>(c, "repeats");
  d.settings_json =
      c.at("settings")
          .dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

// The first field beside the settings that was not read; empty = none. Settings
// are kept whole.
std::string UnknownField(const ordered_json& configuration) {
  ordered_json others = configuration;
  others.erase("settings");
  const ordered_json flat = others.flatten();
  for (const auto& [path, value] : flat.items()) {
    if (FindField("/configuration" + path) == nullptr) {
      return "/configuration" + path;
    }
  }
  return "";
}

void ReadOrigin(const ordered_json& j, RunDescription& d) {
  d.shard.index = advisor::IntegerAt<int>(j.at("shard"), "index");
  d.shard.count = advisor::IntegerAt<int>(j.at("shard"), "count");
  d.jobs = advisor::IntegerAt<int>(j, "jobs");
  j.at("build").at("id").get_to(d.build_id);
  j.at("command_line").get_to(d.command_line);
  j.at("machine").get_to(d.machine);
  j.at("started").get_to(d.started);
  j.at("finished").get_to(d.finished);
  j.at("models").get_to(d.models);
  if (!j.contains("recorded")) return;  // Of runs that replay.
  j.at("recorded").at("first").get_to(d.recorded.first);
  j.at("recorded").at("last").get_to(d.recorded.last);
}

}  // namespace

void RecordedTimes::Add(const std::string& utc) {
  if (utc.empty()) return;
  if (first.empty() || utc < first) first = utc;
  if (utc > last) last = utc;
}

void RecordedTimes::Add(const RecordedTimes& other) {
  Add(other.first);
  Add(other.last);
}

std::string RecordedTimes::Days() const {
  constexpr std::size_t kDayLength = 10;  // Of "2026-01-31T12:00:00Z".
  const std::string from = first.substr(0, kDayLength);
  const std::string to = last.substr(0, kDayLength);
  return from == to ? from : from + " to " + to;
}

bool RunDescription::SameFigures(const RunDescription& other) const {
  return DecidingValues(*this) == DecidingValues(other);
}

bool RunDescription::SameRow(const RunDescription& other) const {
  return SameFigures(other) && models == other.models &&
         recorded.Days() == other.recorded.Days();
}

std::string JointsName(planner::JointRule joints) {
  switch (joints) {
    case planner::JointRule::kTwoStrides:
      return "2r";
    case planner::JointRule::kCell:
      return "cell";
    case planner::JointRule::kVisible:
      return "visible";
  }
  return "";
}

RunDescription DescribeRun(const DatasetFolder& dataset,
                           const CaseSurvey& survey, const RunOptions& options,
                           const MethodRun& run, const RunOrigin& origin) {
  RunDescription d;
  const MethodInfo& info = run.choice.info;
  d.method = info.method;
  d.backend = info.backend;
  d.title = info.title;
  d.rule = info.rule;
  d.asks_model = info.asks_model;
  d.simulated = info.simulated;
  d.dataset_name = dataset.name;
  d.dataset_version = dataset.version;
  d.dataset_digest = survey.dataset_digest;
  d.case_list_digest = survey.case_list_digest;
  d.num_cases = survey.num_selected;
  d.stride = options.lattice.stride;
  d.joints = JointsName(options.lattice.joints);
  d.corner_cutting = options.cost_model.corner_cutting;
  d.clearance_cells = options.cost_model.clearance_cells;
  d.repeats = options.repeats;
  d.settings_json = run.settings_json;
  d.shard = options.shard;
  d.jobs = NumJobs(options.jobs);
  d.build_id = origin.build_id;
  d.command_line = origin.command_line;
  d.machine = MachineText();
  d.started = {UtcNow()};
  return d;
}

Status WriteRunDescription(const RunDescription& d, const std::string& path) {
  const bool dirty = d.build_id.find("-dirty") != std::string::npos;
  ordered_json document = {
      {"schema", RunDescription::kSchema},
      {"configuration", ConfigurationJson(d)},
      {"shard", {{"index", d.shard.index}, {"count", d.shard.count}}},
      {"jobs", d.jobs},
      {"build", {{"id", d.build_id}, {"dirty", dirty}}},
      {"command_line", d.command_line},
      {"machine", d.machine},
      {"started", d.started},
      {"finished", d.finished},
      {"models", d.models}};
  if (!d.recorded.first.empty()) {
    document["recorded"] = {{"first", d.recorded.first},
                            {"last", d.recorded.last}};
  }
  // Names of files need not be UTF-8, which JSON must be.
  return WriteWholeFile(
      path,
      document.dump(2, ' ', false, ordered_json::error_handler_t::replace) +
          "\n");
}

Result<RunDescription> ReadRunDescription(const std::string& path) {
  const Result<std::string> text = ReadWholeFile(path, kMaxRunJsonBytes);
  if (!text.ok()) return text.error();
  try {
    const auto document = ordered_json::parse(*text);
    if (!document.is_object() || !document.contains("schema") ||
        !document.contains("configuration")) {
      return Error{ErrorCode::kUnsupported,
                   path +
                       ": not written by terra bench run (no schema, no "
                       "configuration)"};
    }
    const int schema = advisor::IntegerAt<int>(document, "schema");
    if (schema != RunDescription::kSchema) {
      return Error{ErrorCode::kUnsupported,
                   path + ": schema " + std::to_string(schema) +
                       ", this program reads " +
                       std::to_string(RunDescription::kSchema)};
    }
    RunDescription d;
    const ordered_json& configuration = document.at("configuration");
    ReadConfiguration(configuration, d);
    const std::string unknown = UnknownField(configuration);
    if (!unknown.empty()) {
      return Error{ErrorCode::kInvalid,
                   path + ": this program does not know the field " + unknown +
                       " and cannot tell what it changes"};
    }
    ReadOrigin(document, d);
    if (d.num_cases < 0 || d.repeats < 1 || d.shard.index < 1 ||
        d.shard.index > d.shard.count) {
      return Error{ErrorCode::kInvalid,
                   path + ": no such number of cases, repeats or shards"};
    }
    return d;
  } catch (const nlohmann::json::exception& error) {
    return Error{ErrorCode::kInvalid, path + ": " + advisor::JsonFault(error)};
  }
}

}  // namespace terra::benchmark

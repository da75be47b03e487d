#include "benchmark/run_labels.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "terrain/files/csv.h"

namespace terra::benchmark {
namespace {

std::string Recorded(const LoadedRun& run) {
  const std::string days = run.description.recorded.Days();
  return days.empty() ? "" : "; recorded " + days;
}

bool HasGroup(const LoadedRun& run, const std::string& group) {
  const std::vector<std::string> groups = GroupsOf(run);
  return std::find(groups.begin(), groups.end(), group) != groups.end();
}

}  // namespace

bool IsGenerated(const LoadedRun& run) {
  return HasGroup(run, "easy") || HasGroup(run, "hard");
}

bool IsRugd(const LoadedRun& run) {
  return HasGroup(run, "creek") || HasGroup(run, "park") ||
         HasGroup(run, "trail") || HasGroup(run, "village");
}

std::string SettingOf(const LoadedRun& run, const std::string& name,
                      const std::string& otherwise) {
  const auto settings = nlohmann::json::parse(run.description.settings_json);
  const auto found = settings.find(name);
  if (found == settings.end()) return otherwise;
  if (found->is_number()) return FormatNumber(found->get<double>());
  return found->is_string() ? found->get<std::string>() : found->dump();
}

bool IsAdvisedByModel(const LoadedRun& run) {
  return run.description.asks_model && run.description.method == "advisor";
}

bool HasAllSwitchesOn(const LoadedRun& run) {
  return SettingOf(run, "overlay", "true") == "true" &&
         SettingOf(run, "route_text", "true") == "true" &&
         SettingOf(run, "rea", "true") == "true";
}

bool IsPlain(const LoadedRun& run) {
  return SettingOf(run, "noise", "0") == "0" && HasAllSwitchesOn(run);
}

std::string RowTitle(const LoadedRun& run) {
  std::string title = run.description.title;
  if (run.description.asks_model) {
    std::string models;
    for (const std::string& model : run.description.models) {
      models += (models.empty() ? "" : ", ") + model;
    }
    title += ": " + (models.empty() ? "model not named" : models) +
             " (asked for " + SettingOf(run, "model", "?") + Recorded(run) +
             ")";
  }
  if (run.description.simulated) title += " [SIMULATED]";
  if (!run.complete()) title += " [incomplete]";
  return title;
}

std::string ProviderOf(const LoadedRun& run) {
  return SettingOf(run, "provider", run.description.backend);
}

std::string DatasetTitle(const RunDescription& d) {
  return (d.dataset_name.empty() ? "unnamed dataset" : d.dataset_name) +
         (d.dataset_version.empty() ? "" : " " + d.dataset_version);
}

std::vector<std::string> GroupsOfAll(const std::vector<LoadedRun>& runs) {
  std::vector<std::string> groups;
  for (const LoadedRun& run : runs) {
    for (const std::string& group : GroupsOf(run)) {
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) {
        groups.push_back(group);
      }
    }
  }
  return groups;
}

}  // namespace terra::benchmark

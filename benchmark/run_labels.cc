#include "benchmark/run_labels.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "advisor/wire_format.h"
#include "benchmark/method.h"
#include "benchmark/run_fields.h"

namespace terra::benchmark {
namespace {

std::string Joined(const std::vector<std::string>& parts,
                   const std::string& between) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : between) + part;
  }
  return text;
}

// The model that the paper asked of a provider; empty for another provider.
std::string PaperModelOf(const std::string& provider) {
  const auto format = advisor::MakeWireFormat(provider);
  return format ? std::string(format->default_model()) : "";
}

// "asked for MODEL": whose it is where that is not to be seen from its name,
// and how it was asked where that was not the provider's own way.
std::string Asked(const LoadedRun& run) {
  const std::string model = SettingOf(run, "model");
  const std::string provider = ProviderOf(run);
  const std::string& backend = run.description.backend;
  const bool usual = !model.empty() && model == PaperModelOf(provider);
  return "asked for " + (model.empty() ? "?" : model) +
         (usual ? "" : " of " + provider) +
         (backend == provider ? "" : " by " + backend);
}

// [SIMULATED] says that the endpoint is this machine's, and who answers by
// `exchange` answers in files.
std::set<std::string_view> ShownOf(const LoadedRun& run,
                                   std::set<std::string_view> shown) {
  const std::string endpoint = SettingOf(run, "endpoint_class");
  if ((run.description.simulated && endpoint == "loopback") ||
      (ProviderOf(run) == "exchange" && endpoint == "file")) {
    shown.insert("/configuration/settings/endpoint_class");
  }
  return shown;
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

std::string SettingOf(const LoadedRun& run, const std::string& name) {
  const FieldValues values = DecidingValues(run.description);
  const auto found = values.find("/configuration/settings/" + name);
  if (found == values.end()) return "";
  const auto value = nlohmann::json::parse(found->second, nullptr, false);
  return value.is_string() ? value.get<std::string>() : found->second;
}

bool IsAdvisedByModel(const LoadedRun& run) {
  return run.description.asks_model && run.description.method == "advisor";
}

bool HasAllSwitchesOn(const LoadedRun& run) {
  return IsAtPaper(run.description, FieldRole::kAblation);
}

bool IsPlain(const LoadedRun& run) {
  return IsAtPaper(run.description, FieldRole::kNoise) && HasAllSwitchesOn(run);
}

bool IsOfAblation(const LoadedRun& run) {
  return IsAdvisedByModel(run) &&
         IsAtPaper(run.description, FieldRole::kNoise) &&
         IsAtPaper(run.description, FieldRole::kBeyond);
}

bool IsOfNoise(const LoadedRun& run) {
  return IsAdvisedByModel(run) && HasAllSwitchesOn(run) &&
         IsAtPaper(run.description, FieldRole::kBeyond);
}

bool IsOfGap(const LoadedRun& run) {
  return IsPlain(run) && run.description.rule.fallback;
}

bool StandsForPaper(const LoadedRun& run, const std::string& method,
                    const std::string& provider) {
  const RunDescription& d = run.description;
  return d.asks_model && !d.simulated && d.method == method &&
         ProviderOf(run) == provider &&
         SettingOf(run, "model") == PaperModelOf(provider) &&
         d.rule.fallback == FallsBack(method) &&
         IsAtPaper(d, FieldRole::kBeyond);
}

std::string RowTitle(const LoadedRun& run,
                     const std::set<std::string_view>& shown) {
  const RunDescription& d = run.description;
  std::string title = TitleWithGate({d.method, d.backend, d.title, d.rule});
  std::vector<std::string> more = WordsOf(d, ShownOf(run, shown));
  if (d.asks_model) {
    title +=
        ": " + (d.models.empty() ? "model not named" : Joined(d.models, ", "));
    more.insert(more.begin(), Asked(run));
    const std::string days = d.recorded.Days();
    if (!days.empty()) more.push_back("recorded " + days);
  }
  if (!more.empty()) title += " (" + Joined(more, "; ") + ")";
  if (d.simulated) title += " [SIMULATED]";
  if (!run.complete()) title += " [incomplete]";
  return title;
}

std::string ProviderOf(const LoadedRun& run) {
  const std::string provider = SettingOf(run, "provider");
  return provider.empty() ? run.description.backend : provider;
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

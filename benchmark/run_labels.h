#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"

namespace terra::benchmark {

/// A run's name in tables: title; of a model also which one, and when a
/// recording was made; SIMULATED or incomplete.
std::string RowTitle(const LoadedRun& run);

/// A setting of a run ("noise", "overlay", ...), as text; the default where it
/// has none.
std::string SettingOf(const LoadedRun& run, const std::string& name,
                      const std::string& otherwise);

/// Is the run on generated maps, or on RUGD? By the groups of its cases.
bool IsGenerated(const LoadedRun& run);
bool IsRugd(const LoadedRun& run);

/// Is it `advisor` with a model's answers?
bool IsAdvisedByModel(const LoadedRun& run);

/// Is the model shown all it can be: overlay, route text and reference pair?
bool HasAllSwitchesOn(const LoadedRun& run);

/// Has the run no noise and no ablation: may it stand in the main tables?
bool IsPlain(const LoadedRun& run);

/// Who answered; recordings name the provider that did.
std::string ProviderOf(const LoadedRun& run);

/// "multiterrapath-like 1", or "unnamed dataset".
std::string DatasetTitle(const RunDescription& description);

/// The groups of all runs, in order of appearance.
std::vector<std::string> GroupsOfAll(const std::vector<LoadedRun>& runs);

/// What the small figures are.
inline constexpr const char* kIntervalNote =
    "Small figures: 95 % intervals; rates Wilson, means bootstrap over cases "
    "(10,000 resamples, of more than 100,000 cases 1,000; fixed seed; of more "
    "than 4 million cases from a sample of them, as are times).";

}  // namespace terra::benchmark

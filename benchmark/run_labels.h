#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "benchmark/loaded_run.h"

namespace terra::benchmark {

/// A run's name in tables: its method; of a model also which one was asked and
/// which one answered; every setting that is not the paper's (RunFields), but
/// for the `shown` ones, which the table has in columns of their own; when a
/// recording was made; SIMULATED or incomplete. Runs with the same title
/// differ in nothing that decides their figures, or not in one table
/// (FindMismatch).
std::string RowTitle(const LoadedRun& run,
                     const std::set<std::string_view>& shown = {});

/// A setting of a run ("noise", "overlay", ...), as text; the paper's value
/// where it has none, else empty.
std::string SettingOf(const LoadedRun& run, const std::string& name);

/// Is the run on generated maps, or on RUGD? By the groups of its cases.
bool IsGenerated(const LoadedRun& run);
bool IsRugd(const LoadedRun& run);

/// Is it `advisor` with a model's answers?
bool IsAdvisedByModel(const LoadedRun& run);

/// Is the model shown all it can be: overlay, route text and reference pair?
bool HasAllSwitchesOn(const LoadedRun& run);

/// Has the run no noise and no ablation: may it stand in the main tables?
bool IsPlain(const LoadedRun& run);

/// Where a run may stand beside others that it is compared with: `advisor` with
/// a model's answers, and all settings the paper's but for the switches, or but
/// for the noise.
bool IsOfAblation(const LoadedRun& run);
bool IsOfNoise(const LoadedRun& run);
/// A plain run of a method with fallback.
bool IsOfGap(const LoadedRun& run);

/// Does it stand for a row of the paper: this method with this provider's model
/// of the paper, really asked? Noise and ablation are the row's own.
bool StandsForPaper(const LoadedRun& run, const std::string& method,
                    const std::string& provider);

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

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/map_generator.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// multiterrapath-like v1: this project's fixed set of 1,000 Easy and 1,000
/// Hard maps. They are not the paper's maps, which are not public.
inline constexpr const char* kReleasedName = "multiterrapath-like";
inline constexpr const char* kReleasedVersion = "1";
inline constexpr std::uint64_t kReleasedSeed = 1;
inline constexpr int kReleasedCount = 1000;

struct GenerateOptions {
  std::vector<Subset> subsets;
  int count = 0;  ///< Cases per subset.
  std::uint64_t seed = 0;
  std::string name;
  std::string version;
  int jobs = 0;  ///< 0 = all cores.
};

/// Writes a dataset folder (docs/benchmark.md): cases.csv, legend.csv,
/// dataset.json, maps, README.md (a card) and SHA256SUMS. cases.csv comes last,
/// so a folder that has one is whole.
///
/// Returns the dataset's digest (see DigestLine).
/// Errors: the folder holds a dataset already, or cannot be written.
Result<std::string> GenerateDataset(const GenerateOptions& options,
                                    const std::string& folder);

/// The digest of a dataset is the SHA-256 of these lines, in order of
/// cases.csv: what is planned on, however it is stored.
std::string DigestLine(const std::string& case_id, std::int64_t map_id,
                       Cell start, Cell goal);

/// Returns "easy_0007".
std::string CaseId(Subset subset, int index);

}  // namespace terra::benchmark

#pragma once

#include <string>

#include "benchmark/generate_dataset.h"

namespace terra::benchmark {

/// Returns the README.md of a generated dataset: what it is, what it is not,
/// its files, how it was made and its licence.
std::string DatasetCard(const GenerateOptions& options);

}  // namespace terra::benchmark

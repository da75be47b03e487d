#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"
#include "benchmark/table.h"

namespace terra::benchmark {

/// "not measured", and what would measure the row of a method with a model:
/// `more` options, into a folder with this suffix.
std::string HowToMeasure(const std::string& method, const std::string& backend,
                         const std::string& more = "",
                         const std::string& suffix = "");

/// Adds a block with the rows of the paper that no run here stands for, if
/// there is one.
void AddMissing(const std::vector<LoadedRun>& runs, Table& table,
                const std::string& more = "", const std::string& suffix = "");

}  // namespace terra::benchmark

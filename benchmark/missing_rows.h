#pragma once

#include <functional>
#include <string>
#include <vector>

#include "benchmark/loaded_run.h"
#include "benchmark/table.h"

namespace terra::benchmark {

/// Heads the block of rows that no run here stands for.
inline constexpr const char* kMissingHeading = "Not measured here";

/// "not measured", and what would measure the row of a method with a model:
/// `more` options, into a folder with this suffix.
std::string HowToMeasure(const std::string& method, const std::string& backend,
                         const std::string& more = "",
                         const std::string& suffix = "");

/// Does a run here stand for the row of a method with a provider's model of the
/// paper? It must have cases of one of the groups.
bool IsMeasured(const std::vector<LoadedRun>& runs, const std::string& method,
                const std::string& provider,
                const std::vector<std::string>& groups);

/// Adds a block with the rows of the paper's main tables that no plain run here
/// stands for, if there is one.
void AddMissing(const std::vector<LoadedRun>& runs,
                const std::vector<std::string>& groups, Table& table,
                const std::string& more = "", const std::string& suffix = "");

/// The groups of RUGD's scenes, and of generated maps.
inline const std::vector<std::string> kScenes = {"creek", "park", "trail",
                                                 "village"};
inline const std::vector<std::string> kSubsets = {"easy", "hard"};

/// Says below a table which of its runs have no row in it, and names them.
void NoteWithoutRow(const std::vector<LoadedRun>& runs,
                    const std::function<bool(const LoadedRun&)>& has_row,
                    const std::string& why, Table& table);

}  // namespace terra::benchmark

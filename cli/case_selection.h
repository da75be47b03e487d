#pragma once

#include <string>
#include <vector>

#include "terrain/files/dataset.h"
#include "terrain/result.h"

namespace CLI {
class App;
}

namespace terra::cli {

/// Adds --cases FILE|N.
void AddCasesOption(CLI::App& command, std::string& cases);

/// Reads what it says: N = the first N ids of each group, else a file with an
/// id a line. Empty = all, and then none are named. Errors: no such file; an id
/// that the dataset does not have.
Result<std::vector<std::string>> SelectCases(const Dataset& dataset,
                                             const std::string& text);

}  // namespace terra::cli

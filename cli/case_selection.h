#pragma once

#include <string>

#include "benchmark/case_list.h"
#include "terrain/result.h"

namespace CLI {
class App;
}

namespace terra::cli {

/// Adds --cases FILE|N.
void AddCasesOption(CLI::App& command, std::string& cases);

/// Reads what it says: N = the first N of each group, else a file with an id a
/// line. Empty = all. Errors: no such file; no id, or one twice.
Result<benchmark::CaseSelection> SelectCases(const std::string& text);

}  // namespace terra::cli

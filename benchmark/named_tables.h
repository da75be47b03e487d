#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "benchmark/report_selection.h"
#include "benchmark/table.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A table that `report` has and `table` prints.
struct NamedTable {
  std::string name;
  /// Its runs, where it is made from all that there are.
  std::vector<LoadedRun> Selection::*runs;
  std::function<Result<Table>(const std::vector<LoadedRun>&)> make;
  /// What its runs may differ in, because it compares just that.
  std::set<Shared> varies;
};

/// All of them.
const std::vector<NamedTable>& NamedTables();

/// Pre: there is one of this name.
const NamedTable& TableNamed(const std::string& name);

}  // namespace terra::benchmark

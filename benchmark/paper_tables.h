#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"
#include "benchmark/table.h"

namespace terra::benchmark {

/// The paper's tables from runs on disk. Each has the measured rows, then a row
/// `not measured` with the command for every row of the paper that no run here
/// stands for, then the paper's rows in a block of their own. Runs against a
/// simulation are marked SIMULATED.
/// Those on a model's switches are in switch_tables.h.
///
/// Pre: runs that are comparable (FindMismatch), but for what the table varies.
Table ComparisonTable(const std::vector<LoadedRun>& runs,
                      const std::string& group);
/// Varies the stride. MOGR is each run's own. Only plain runs of methods with
/// fallback have a row.
Table OracleGapTable(const std::vector<LoadedRun>& runs);
Table RugdTable(const std::vector<LoadedRun>& runs);
Table LatencyTable(const std::vector<LoadedRun>& runs);

}  // namespace terra::benchmark

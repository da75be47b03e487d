#pragma once

#include <string>
#include <vector>

#include "benchmark/loaded_run.h"
#include "benchmark/table.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// What the paper does not print: proposal quality in full, with recovery.
/// Pre: comparable runs (FindMismatch).
Table ProposalTable(const std::vector<LoadedRun>& runs,
                    const std::string& group);
/// Every run against the first one of these, paired by case.
/// Pre: comparable runs. Errors: a run that can no longer be read.
Result<Table> PairedTable(const std::vector<LoadedRun>& runs,
                          const std::string& group);
/// Joint rules side by side: gaps of runs that differ in them.
Table JointsTable(const std::vector<LoadedRun>& runs);
/// What produced each row.
Table RunsTable(const std::vector<LoadedRun>& runs);

}  // namespace terra::benchmark

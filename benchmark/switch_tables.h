#pragma once

#include <vector>

#include "benchmark/loaded_run.h"
#include "benchmark/table.h"

namespace terra::benchmark {

/// The paper's tables on what the model is shown, of the form that
/// paper_tables.h describes.
///
/// Pre: runs that are comparable (FindMismatch), but for what the table varies.

/// Varies overlay, route text and reference pair. Only runs whose other
/// settings are the paper's have a row.
Table AblationTable(const std::vector<LoadedRun>& runs);
/// Varies the noise. Only runs whose other settings are the paper's have a row.
Table NoiseTable(const std::vector<LoadedRun>& runs);

}  // namespace terra::benchmark

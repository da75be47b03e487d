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
///
/// Pre: runs that are comparable (WhyNotComparable), but for what the table
///      varies.
Table ComparisonTable(const std::vector<LoadedRun>& runs,
                      const std::string& group);
/// Varies the stride. MOGR is each run's own.
Table OracleGapTable(const std::vector<LoadedRun>& runs);
/// Varies the switches.
Table AblationTable(const std::vector<LoadedRun>& runs);
Table RugdTable(const std::vector<LoadedRun>& runs);
Table LatencyTable(const std::vector<LoadedRun>& runs);
/// Varies the noise.
Table NoiseTable(const std::vector<LoadedRun>& runs);

/// What the paper does not print: proposal quality in full, with recovery.
Table ProposalTable(const std::vector<LoadedRun>& runs,
                    const std::string& group);
/// Every run against the first one of these, paired by case.
Table PairedTable(const std::vector<LoadedRun>& runs, const std::string& group);
/// Joint rules side by side: gaps of runs that differ in them.
Table JointsTable(const std::vector<LoadedRun>& runs);
/// What produced each row.
Table RunsTable(const std::vector<LoadedRun>& runs);

/// A run's name in tables: title, model, and SIMULATED or incomplete.
std::string RowTitle(const LoadedRun& run);

/// A setting of a run ("noise", "overlay", ...), as text; the default where it
/// has none.
std::string SettingOf(const LoadedRun& run, const std::string& name,
                      const std::string& otherwise);

/// Has the run no noise, no ablation and one repeat's worth of cases: may it
/// stand in the main tables?
bool IsPlain(const LoadedRun& run);

}  // namespace terra::benchmark

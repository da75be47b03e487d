#pragma once

#include <string>

#include "planner/coarse_lattice.h"

namespace CLI {
class App;
}

namespace terra::cli {

/// The subcommands of `terra bench`, by the rules of commands.h, each in its
/// own bench_<name>.cc.
void AddBenchGenerate(CLI::App& bench, int& exit_code);
void AddBenchGap(CLI::App& bench, int& exit_code);
void AddBenchRugd(CLI::App& bench, int& exit_code);
void AddBenchRun(CLI::App& bench, int& exit_code);
void AddBenchMerge(CLI::App& bench, int& exit_code);
void AddBenchTable(CLI::App& bench, int& exit_code);
void AddBenchReport(CLI::App& bench, int& exit_code);
void AddBenchReferences(CLI::App& bench, int& exit_code);
void AddBenchExportBatch(CLI::App& bench, int& exit_code);
void AddBenchImportBatch(CLI::App& bench, int& exit_code);

/// Adds --jobs: threads to use, 0 = all cores.
void AddJobsOption(CLI::App& command, int& jobs);

/// This process's command line, for the record of where figures come from.
std::string CommandLine();

/// Adds --joints cell|2r|visible.
void AddJointsOption(CLI::App& command, planner::JointRule& joints);

}  // namespace terra::cli

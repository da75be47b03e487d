#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planner/coarse_lattice.h"

namespace CLI {
class App;
}

namespace terra::cli {

/// The subcommands of `terra bench`, by the rules of commands.h, each in its
/// own bench_<name>.cc.
void AddBenchGenerate(CLI::App& bench, int& exit_code);
void AddBenchGap(CLI::App& bench, int& exit_code);

/// Adds --jobs: threads to use, 0 = all cores.
void AddJobsOption(CLI::App& command, int& jobs);

/// Adds --joints cell|2r|visible.
void AddJointsOption(CLI::App& command, planner::JointRule& joints);

}  // namespace terra::cli

#include <fstream>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/bench_commands.h"
#include "cli/commands.h"

namespace terra::cli {

void AddBenchCommand(CLI::App& app, int& exit_code) {
  CLI::App& bench = *app.add_subcommand(
      "bench", "Make datasets, run methods on them, print tables and reports");
  bench.require_subcommand(1);
  bench.footer(
      "Example:\n"
      "  terra bench generate --paper --out data\n"
      "  terra bench run --dataset data --method advisor --backend shortcut "
      "--out runs/shortcut\n"
      "  terra bench report --runs runs/shortcut --out report");
  AddBenchGenerate(bench, exit_code);
  AddBenchGap(bench, exit_code);
  AddBenchReferences(bench, exit_code);
  AddBenchRugd(bench, exit_code);
  AddBenchRun(bench, exit_code);
  AddBenchMerge(bench, exit_code);
  AddBenchTable(bench, exit_code);
  AddBenchReport(bench, exit_code);
  AddBenchExportBatch(bench, exit_code);
  AddBenchImportBatch(bench, exit_code);
}

std::string CommandLine() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string text;
  for (std::string argument; std::getline(file, argument, '\0');) {
    const bool plain = argument.find_first_of(" '\"\\$*") == std::string::npos;
    text +=
        (text.empty() ? "" : " ") + (plain ? argument : "'" + argument + "'");
  }
  return text;
}

void AddJobsOption(CLI::App& command, int& jobs) {
  command.add_option("--jobs", jobs, "Threads to use (default: all cores)")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
}

void AddJointsOption(CLI::App& command, planner::JointRule& joints) {
  static const std::map<std::string, planner::JointRule> kRules = {
      {"cell", planner::JointRule::kCell},
      {"2r", planner::JointRule::kTwoStrides},
      {"visible", planner::JointRule::kVisible}};
  const auto read = [&joints](const std::string& name) {
    joints = kRules.at(name);
  };
  command
      .add_option_function<std::string>(
          "--joints", read,
          "How start and goal join the lattice: to the corners of their cell, "
          "to nodes within two strides (default), or to all nodes that a "
          "feasible segment reaches")
      ->check(CLI::IsMember(&kRules).description(""))
      ->type_name("cell|2r|visible");
}

}  // namespace terra::cli

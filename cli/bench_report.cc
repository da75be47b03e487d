#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "benchmark/report.h"
#include "cli/bench_commands.h"
#include "cli/output.h"

namespace terra::cli {

void AddBenchReport(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "report", "All tables and figures from runs on disk, and an HTML page");
  const auto options = std::make_shared<benchmark::ReportOptions>();
  command
      .add_option("--runs", options->runs,
                  "Run folders, or a folder above them")
      ->required()
      ->type_name("DIR ...");
  command
      .add_option("--dataset", options->datasets,
                  "Dataset folders, for the pictures")
      ->type_name("DIR ...");
  command
      .add_option("--frames", options->frames,
                  "Camera frames of RUGD, to be shown above their masks "
                  "(default: those that `bench rugd --frames` was given)")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  command.add_flag("--include-simulated", options->include_simulated,
                   "Let runs against a simulated model into the tables, "
                   "marked SIMULATED");
  command.add_option("--out", options->out, "Folder to write")
      ->required()
      ->type_name("DIR");
  command.footer(
      "Example:\n"
      "  terra bench report --runs runs --dataset data --out report");
  command.callback([options, &exit_code] {
    const Status written = benchmark::WriteReport(*options);
    if (!written.ok()) {
      exit_code = Fail(written.error());
      return;
    }
    std::cout << options->out << "/report.html\n";
  });
}

}  // namespace terra::cli

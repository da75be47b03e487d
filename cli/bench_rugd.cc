#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "benchmark/rugd.h"
#include "cli/bench_commands.h"
#include "cli/output.h"

namespace terra::cli {
namespace {

int RunRugd(const benchmark::RugdOptions& options) {
  const auto counts = benchmark::ConvertRugd(options);
  if (!counts.ok()) return Fail(counts.error());
  for (const benchmark::RugdCount& count : *counts) {
    std::cout << count.group << ": " << count.used << " of " << count.frames
              << " frames used\n";
  }
  std::cout
      << "paper: creek 745 of 836, park 1,638 of 1,640, trail 3,875 of "
         "4,843, village 117 of 117\nskipped frames and other files, and why: "
      << options.out << "/skipped.csv\nderived from RUGD, do not "
      << "redistribute\n";
  return kDone;
}

}  // namespace

void AddBenchRugd(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "rugd", "Turn RUGD annotation masks into a dataset");
  const auto options = std::make_shared<benchmark::RugdOptions>();
  command
      .add_option("--annotations", options->annotations,
                  "RUGD_annotations of the official archive, or a folder of "
                  "masks")
      ->required()
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  command.add_option("--out", options->out, "Folder to write")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--frames", options->frames,
                  "RUGD_frames-with-annotations of the archive: the report "
                  "then shows the frame above its mask")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  command
      .add_option("--seed", options->seed,
                  "Of the choice of start and goal (default 0)")
      ->type_name("S");
  AddJobsOption(command, options->jobs);
  command.footer(
      "Example:\n"
      "  terra bench rugd --annotations RUGD_annotations --out rugd");
  command.callback([options, &exit_code] {
    exit_code = RunRugd(*options);
  });
}

}  // namespace terra::cli

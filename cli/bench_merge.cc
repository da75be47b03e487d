#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "benchmark/merge.h"
#include "cli/bench_commands.h"
#include "cli/output.h"

namespace terra::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
};

int RunMerge(const MergeArguments& arguments) {
  const auto rows = benchmark::MergeRuns(arguments.shards, arguments.out);
  if (!rows.ok()) return Fail(rows.error());
  std::cout << arguments.out << ": " << *rows << " rows\n";
  return kDone;
}

}  // namespace

void AddBenchMerge(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "merge", "Put the finished shards of a run together");
  const auto arguments = std::make_shared<MergeArguments>();
  command.add_option("shards", arguments->shards, "Folders of the shards")
      ->required()
      ->type_name("DIR ...");
  command.add_option("--out", arguments->out, "Folder to write")
      ->required()
      ->type_name("DIR");
  command.footer(
      "Example:\n"
      "  terra bench merge --out runs/search runs/search.1 runs/search.2");
  command.callback([arguments, &exit_code] {
    exit_code = RunMerge(*arguments);
  });
}

}  // namespace terra::cli

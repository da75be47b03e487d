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
  const auto counts = benchmark::MergeRuns(arguments.shards, arguments.out);
  if (!counts.ok()) return Fail(counts.error());
  std::cout << arguments.out << ": " << counts->rows << " rows";
  if (counts->missing > 0) {
    std::cout << ", " << counts->missing << " missing: a part is not finished";
  }
  std::cout << "\n";
  return counts->missing > 0 ? kCouldNot : kDone;
}

}  // namespace

void AddBenchMerge(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "merge", "Put the shards of a run together (exit 1 if some are missing)");
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

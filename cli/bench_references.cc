#include <cstdint>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "benchmark/reference_builder.h"
#include "bus/map_file_options.h"
#include "cli/bench_commands.h"
#include "cli/output.h"
#include "output/output_file.h"

namespace terra::cli {
namespace {

struct ReferencesArguments {
  std::string dataset;  // Empty = generated maps.
  std::uint64_t seed = benchmark::kPoolSeed;
  int count = 20;
  std::string out;
  UnknownGround unknown;
};

int RunReferences(const ReferencesArguments& arguments) {
  const auto pool =
      arguments.dataset.empty()
          ? benchmark::BuildGeneratedPool(arguments.seed, arguments.count)
          : benchmark::BuildDatasetPool(arguments.dataset, arguments.count,
                                        arguments.unknown);
  if (!pool.ok()) return Fail(pool.error());
  const Status written = WriteWholeFile(arguments.out, pool->Serialize());
  if (!written.ok()) return Fail(written.error());
  std::cout << arguments.out << ": " << pool->pairs().size() << " pairs, id "
            << pool->id() << "\n";
  return kDone;
}

}  // namespace

void AddBenchReferences(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "references", "Build a pool of reference pairs to show to a model");
  const auto arguments = std::make_shared<ReferencesArguments>();
  CLI::Option* dataset =
      command
          .add_option("--dataset", arguments->dataset,
                      "Maps to take pairs from (default: generated ones)")
          ->type_name("DIR");
  command
      .add_option("--seed", arguments->seed,
                  "Of the generated maps; not that of the released set")
      ->capture_default_str()
      ->excludes(dataset);
  command.add_option("--count", arguments->count, "Pairs to build at most")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000));
  bus::AddUnknownOption(command, arguments->unknown);
  command.add_option("--out", arguments->out, "File to write")
      ->required()
      ->type_name("F.jsonl");
  command.footer(
      "Example:\n"
      "  terra bench references --dataset rugd --out rugd-pool.jsonl\n"
      "Used with --references F.jsonl of advise, prompt and terra-advisor.");
  command.callback([arguments, &exit_code] {
    exit_code = RunReferences(*arguments);
  });
}

}  // namespace terra::cli

#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "benchmark/generate_dataset.h"
#include "cli/bench_commands.h"
#include "cli/output.h"

namespace terra::cli {
namespace {

using benchmark::GenerateOptions;
using benchmark::Subset;

struct GenerateArguments {
  GenerateOptions options;
  std::string subset;
  bool paper = false;
  std::string out;
};

std::vector<Subset> SubsetsOf(const std::string& name) {
  const auto found = benchmark::FindSubset(name);
  if (found) return {*found};
  return {Subset::kEasy, Subset::kHard};
}

int RunGenerate(GenerateArguments& arguments) {
  GenerateOptions& options = arguments.options;
  options.subsets = SubsetsOf(arguments.paper ? "both" : arguments.subset);
  options.name =
      arguments.paper ? benchmark::kReleasedName : "multiterrapath-like-custom";
  options.version = arguments.paper ? benchmark::kReleasedVersion : "";
  if (arguments.paper) {
    options.seed = benchmark::kReleasedSeed;
    if (options.count == 0) options.count = benchmark::kReleasedCount;
  }
  if (arguments.paper && options.count != benchmark::kReleasedCount) {
    options.version += "-first-" + std::to_string(options.count);
  }
  const Result<std::string> digest =
      benchmark::GenerateDataset(options, arguments.out);
  if (!digest.ok()) return Fail(digest.error());
  std::cout << arguments.out << ": "
            << options.count * static_cast<int>(options.subsets.size())
            << " cases, digest " << *digest << "\n";
  return kDone;
}

}  // namespace

void AddBenchGenerate(CLI::App& bench, int& exit_code) {
  CLI::App& command =
      *bench.add_subcommand("generate", "Draw a MultiTerraPath-style dataset");
  const auto arguments = std::make_shared<GenerateArguments>();
  GenerateOptions& options = arguments->options;
  CLI::Option* subset =
      command.add_option("--subset", arguments->subset, "Which maps to draw")
          ->check(CLI::IsMember({"easy", "hard", "both"}));
  CLI::Option* count =
      command.add_option("--count", options.count, "Cases per subset")
          ->check(CLI::Range(1, 10'000'000))
          ->type_name("N");
  CLI::Option* seed = command
                          .add_option("--seed", options.seed,
                                      "Any number; it decides every map")
                          ->type_name("S");
  command
      .add_flag("--paper", arguments->paper,
                "multiterrapath-like v1: 1,000 Easy and 1,000 Hard maps of the "
                "released seed (with --count: the first ones)")
      ->excludes(subset)
      ->excludes(seed);
  command.add_option("--out", arguments->out, "Folder to write")
      ->required()
      ->type_name("DIR");
  AddJobsOption(command, options.jobs);
  command.footer(
      "Example:\n"
      "  terra bench generate --subset hard --count 50 --seed 7 --out maps\n"
      "  terra bench generate --paper --out multiterrapath-like");
  command.parse_complete_callback([arguments, subset, count, seed] {
    if (arguments->paper) return;
    for (const CLI::Option* needed : {subset, count, seed}) {
      if (needed->empty()) {
        throw CLI::RequiredError(needed->get_name() + " (or --paper)");
      }
    }
  });
  command.callback([arguments, &exit_code] {
    exit_code = RunGenerate(*arguments);
  });
}

}  // namespace terra::cli

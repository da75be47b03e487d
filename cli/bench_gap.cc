#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "benchmark/gap.h"
#include "bus/map_file_options.h"
#include "cli/bench_commands.h"
#include "cli/legend_notice.h"
#include "cli/map_arguments.h"
#include "cli/output.h"

namespace terra::cli {
namespace {

struct GapArguments {
  std::string dataset;
  UnknownGround unknown;
  benchmark::GapOptions options;
  std::string out;
};

void PrintSummary(const std::vector<benchmark::GapSummary>& summaries) {
  std::puts("group        stride  cases  comparable  gap rate %  mean gap %");
  for (const benchmark::GapSummary& row : summaries) {
    const double rate = row.comparable == 0
                            ? 0
                            : 100.0 * static_cast<double>(row.gaps) /
                                  static_cast<double>(row.comparable);
    std::printf("%-12s %6d %6lld %11lld %11.2f %11.2f\n", row.group.c_str(),
                row.stride, static_cast<long long>(row.paths),
                static_cast<long long>(row.comparable), rate,
                100 * row.mean_gap);
  }
}

int RunGap(const GapArguments& arguments) {
  const Result<DatasetFolder> dataset =
      OpenDataset(arguments.dataset, arguments.unknown);
  if (!dataset.ok()) return Fail(dataset.error());
  NoteHowMapsAreRead(*dataset);
  const auto summaries =
      benchmark::MeasureGaps(*dataset, arguments.options, arguments.out);
  if (!summaries.ok()) return Fail(summaries.error());
  PrintSummary(*summaries);
  return kDone;
}

}  // namespace

void AddBenchGap(CLI::App& bench, int& exit_code) {
  CLI::App& command = *bench.add_subcommand(
      "gap", "Cost of the lattice route at several strides beside the optimum");
  const auto arguments = std::make_shared<GapArguments>();
  command.add_option("--dataset", arguments->dataset, "Dataset folder")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--strides", arguments->options.strides,
                  "Strides, separated by commas (default 10,20,50,100)")
      ->delimiter(',')
      ->check(CLI::Range(1, TerrainMap::kMaxSide))
      ->type_name("R,...");
  command
      .add_option("--out", arguments->out,
                  "CSV to write: case_id,stride,baseline_cost,oracle_cost")
      ->required()
      ->type_name("F.csv");
  AddJointsOption(command, arguments->options.joints);
  AddCostModelOptions(command, arguments->options.cost_model);
  bus::AddUnknownOption(command, arguments->unknown);
  AddJobsOption(command, arguments->options.jobs);
  command.footer(
      "Example:\n"
      "  terra bench gap --dataset data --strides 10,20,50,100 --out gap.csv");
  command.callback([arguments, &exit_code] {
    exit_code = RunGap(*arguments);
  });
}

}  // namespace terra::cli

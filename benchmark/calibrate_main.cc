// terra-calibrate: draws maps with given parameters and prints their oracle
// gaps beside the paper's. Parameters default to the calibrated ones. How the
// generator was fitted: docs/benchmark.md.
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "benchmark/gap.h"
#include "benchmark/map_generator.h"
#include "benchmark/paper_rows.h"
#include "benchmark/parallel.h"
#include "output/standard_output.h"

namespace {

namespace tb = terra::benchmark;

struct Range {
  const char* name;
  tb::IntRange* range;
};

// Adds "--name LOW,HIGH" for every range, and the single numbers.
void AddParameters(CLI::App& app, tb::MapParameters& p) {
  const std::vector<Range> ranges = {
      {"--polygons", &p.polygons},
      {"--radius", &p.star.radius},
      {"--corners", &p.star.corners},
      {"--corner-percent", &p.star.percent},
      {"--ribbon-half-width", &p.ribbon_half_width},
      {"--ribbon-amplitude", &p.ribbon_amplitude},
      {"--ribbon-angle", &p.ribbon_angle},
      {"--obstacles", &p.obstacles},
      {"--obstacle-short", &p.obstacle_short},
      {"--obstacle-long", &p.obstacle_long},
  };
  for (const Range& range : ranges) {
    app.add_option_function<std::vector<int>>(
           range.name,
           [to = range.range](const std::vector<int>& v) {
             *to = {v.at(0), v.at(1)};
           })
        ->delimiter(',')
        ->expected(2)
        ->type_name("LOW,HIGH");
  }
  app.add_option("--separation", p.separation);
  app.add_option("--obstacle-edge-distance", p.obstacle_edge_distance);
  app.add_option("--end-margin", p.end_margin);
  app.add_option("--end-distance", p.end_distance);
}

std::vector<tb::GapSummary> Measure(tb::Subset subset, std::uint64_t seed,
                                    int count,
                                    const tb::MapParameters& parameters) {
  const tb::GapOptions options;
  std::vector<tb::CaseGap> gaps(static_cast<std::size_t>(count));
  tb::ParallelFor(count, options.jobs, [&](std::int64_t i) {
    const tb::GeneratedCase drawn =
        tb::GenerateCase(subset, seed, static_cast<int>(i), parameters);
    gaps[static_cast<std::size_t>(i)] =
        tb::MeasureGap(drawn.map, drawn.start, drawn.goal, options);
  });
  tb::GapSummaries summaries(options.strides);
  for (const tb::CaseGap& gap : gaps) summaries.Add("", gap);
  return summaries.Rows();
}

void Print(tb::Subset subset, const std::vector<tb::GapSummary>& rows) {
  std::puts("stride  gap rate %  paper   mean gap %  paper   ratio");
  for (const tb::GapSummary& row : rows) {
    const tb::PaperGap paper = tb::PaperGapOf(subset, row.stride);
    const double rate = 100.0 * static_cast<double>(row.gaps) /
                        static_cast<double>(row.comparable);
    const double gap = 100 * row.mean_gap;
    std::printf("%6d %11.2f %6.2f %12.2f %6.2f %7.3f\n", row.stride, rate,
                paper.gap_rate, gap, paper.mean_gap, gap / paper.mean_gap);
  }
}

// A subcommand per subset, because the defaults differ.
void AddSubset(CLI::App& app, tb::Subset subset) {
  struct Arguments {
    tb::MapParameters parameters;
    std::uint64_t seed = 101;
    int count = 1000;
  };
  const auto arguments = std::make_shared<Arguments>();
  arguments->parameters = tb::CalibratedParameters(subset);
  CLI::App& command = *app.add_subcommand(std::string(SubsetName(subset)));
  command.add_option("--seed", arguments->seed, "Not the released set's");
  command.add_option("--count", arguments->count, "Maps to draw");
  AddParameters(command, arguments->parameters);
  command.callback([arguments, subset] {
    Print(subset, Measure(subset, arguments->seed, arguments->count,
                          arguments->parameters));
  });
}

int Run(int argc, char** argv) {
  CLI::App app{"Oracle gaps of generated maps beside the paper's"};
  app.require_subcommand(1);
  AddSubset(app, tb::Subset::kEasy);
  AddSubset(app, tb::Subset::kHard);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  terra::ReserveStandardStreams();
  int exit_code = 1;
  try {
    exit_code = Run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "terra-calibrate: %s\n", error.what());
  }
  return terra::FinishStandardOutput("terra-calibrate", exit_code);
}

// terra-speed: times searches, the deterministic chain and what carries maps,
// beside other implementations, in one run, with Google Benchmark. Keeps what
// it measures case by case (speed_folder.h) and goes on where it was broken
// off; speed_report.py makes tables of it.

#include <cstdio>
#include <exception>
#include <iterator>
#include <string>

#include <CLI/CLI.hpp>

#include "benchmark/progress.h"
#include "benchmark/speed/speed_folder.h"
#include "benchmark/speed/works.h"
#include "output/standard_output.h"

namespace terra::benchmark {
namespace {

constexpr int kRounds = 5;

struct Amount {
  int side;
  int maps;          // Of each subset.
  int maps_written;  // Of these, for the slowest peers.
  int rounds;
};

// Within five minutes. The sides at which figures are to be reached over many
// maps have them; at 4000 the graph libraries take seconds for each query.
constexpr Amount kFull[] = {{500, 50, 8, kRounds},
                            {1000, 6, 2, kRounds},
                            {2000, 3, 1, 3},
                            {4000, 1, 1, 2}};
constexpr Amount kQuick[] = {{500, 3, 2, kRounds}, {1000, 1, 1, kRounds}};

void RunCase(Subset subset, int index, const Amount& amount,
             const SpeedFolder& folder) {
  const SpeedCase c = MakeGeneratedCase(subset, index, amount.side);
  if (index < amount.maps_written) {
    folder.WriteMap(c);
  }
  std::vector<TimedSample> samples = TimeSearches(c, amount.rounds);
  for (const auto& more :
       {TimeChain(c, amount.rounds), TimeData(c, amount.rounds)}) {
    samples.insert(samples.end(), more.begin(), more.end());
  }
  folder.WriteSamples(c, samples);
}

void RunSide(const Amount& amount, const SpeedFolder& folder) {
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    const std::string family(SubsetName(subset));
    Progress progress(std::to_string(amount.side) + " x " +
                          std::to_string(amount.side) + ", " + family,
                      amount.maps);
    for (int i = 0; i < amount.maps; ++i) {
      if (!folder.Has(amount.side, family, i)) {
        RunCase(subset, i, amount, folder);
      }
      progress.Advance();
    }
  }
}

void RunWorstCases(const SpeedFolder& folder) {
  const std::vector<SpeedCase> cases = MakeWorstCases();
  Progress progress("worst cases", std::ssize(cases));
  for (const SpeedCase& c : cases) {
    if (!folder.Has(c.map.width(), c.family, c.index)) {
      folder.WriteSamples(c, TimeWorstCase(c, kRounds));
    }
    progress.Advance();
  }
}

void Run(const std::string& path, bool quick) {
  const SpeedFolder folder(path);
  if (quick) {
    for (const Amount& amount : kQuick) RunSide(amount, folder);
  } else {
    for (const Amount& amount : kFull) RunSide(amount, folder);
  }
  RunWorstCases(folder);
}

}  // namespace
}  // namespace terra::benchmark

int main(int argc, char** argv) {
  terra::ReserveStandardStreams();
  CLI::App app{"Times searches beside other implementations"};
  std::string folder;
  bool quick = false;
  app.add_option("--out", folder, "Folder for the samples; what it holds stays")
      ->required();
  app.add_flag("--quick", quick, "Few and small maps: does it work at all?");
  int exit_code = 1;
  try {
    app.parse(argc, argv);
    terra::benchmark::Run(folder, quick);
    exit_code = 0;
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "terra-speed: %s\n", error.what());
  }
  return terra::FinishStandardOutput("terra-speed", exit_code);
}

// terra-speed: times searches, the deterministic chain and what carries maps,
// beside other implementations, in one run. Writes FOLDER/samples.csv (one time
// per map and work) and FOLDER/maps (for peers in other languages);
// speed_report.py makes tables of it.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include <CLI/CLI.hpp>

#include "benchmark/speed/works.h"
#include "terrain/require.h"

namespace terra::benchmark {
namespace {

constexpr int kRounds = 5;

struct Amount {
  int side;
  int maps;  // Of each subset.
  Peers peers;
};

constexpr Amount kFull[] = {{500, 50, Peers::kAll},
                            {1000, 16, Peers::kAll},
                            {2000, 6, Peers::kAll},
                            {4000, 4, Peers::kWithoutGraphs}};
constexpr Amount kQuick[] = {{500, 3, Peers::kAll},
                             {1000, 1, Peers::kWithoutGraphs}};
// For the slowest peers, which have no use for many.
constexpr int kMapsWritten = 8;
constexpr int kLargestWritten = 1000;

class SpeedRun {
 public:
  explicit SpeedRun(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_ / "maps");
    samples_.open(folder_ / "samples.csv");
    samples_ << "side,family,index,work,microseconds,amount\n";
    maps_.open(folder_ / "maps" / "cases.csv");
    maps_ << "side,family,index,file,start_x,start_y,goal_x,goal_y\n";
  }

  void Add(const SpeedCase& c, const std::vector<TimedSample>& samples) {
    for (const TimedSample& s : samples) {
      samples_ << c.map.width() << ',' << c.family << ',' << c.index << ",\""
               << s.name << "\"," << s.microseconds << ',' << s.amount << '\n';
    }
    samples_.flush();
  }

  // The costs of all cells as float32, row by row, infinite where blocked.
  void WriteMap(const SpeedCase& c) {
    const std::string name = std::to_string(c.map.width()) + "-" + c.family +
                             "-" + std::to_string(c.index) + ".f32";
    std::ofstream file(folder_ / "maps" / name, std::ios::binary);
    for (int y = 0; y < c.map.height(); ++y) {
      for (int x = 0; x < c.map.width(); ++x) {
        const auto cost = static_cast<float>(c.map.Cost({x, y}));
        file.write(reinterpret_cast<const char*>(&cost), sizeof(cost));
      }
    }
    maps_ << c.map.width() << ',' << c.family << ',' << c.index << ',' << name
          << ',' << c.start.x << ',' << c.start.y << ',' << c.goal.x << ','
          << c.goal.y << '\n';
    TERRA_REQUIRE(file.good());
  }

  bool Close() {
    samples_.close();
    maps_.close();
    return !samples_.fail() && !maps_.fail();
  }

 private:
  std::filesystem::path folder_;
  std::ofstream samples_;
  std::ofstream maps_;
};

void RunSide(const Amount& amount, SpeedRun& run) {
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    std::fprintf(stderr, "%d x %d, %s\n", amount.side, amount.side,
                 std::string(SubsetName(subset)).c_str());
    for (int i = 0; i < amount.maps; ++i) {
      const SpeedCase c = MakeGeneratedCase(subset, i, amount.side);
      run.Add(c, TimeSearches(c, amount.peers, kRounds));
      run.Add(c, TimeChain(c, kRounds));
      run.Add(c, TimeData(c, kRounds));
      if (i < kMapsWritten && amount.side <= kLargestWritten) run.WriteMap(c);
    }
  }
}

int Run(const std::string& folder, bool quick) {
  SpeedRun run(folder);
  if (quick) {
    for (const Amount& amount : kQuick) RunSide(amount, run);
  } else {
    for (const Amount& amount : kFull) RunSide(amount, run);
  }
  std::fprintf(stderr, "worst cases\n");
  for (const SpeedCase& c : MakeWorstCases()) {
    run.Add(c, TimeWorstCase(c, kRounds));
  }
  return run.Close() ? 0 : 1;
}

}  // namespace
}  // namespace terra::benchmark

int main(int argc, char** argv) {
  CLI::App app{"Times searches beside other implementations"};
  std::string folder;
  bool quick = false;
  app.add_option("--out", folder, "Folder for the samples")->required();
  app.add_flag("--quick", quick, "Few and small maps: does it work at all?");
  CLI11_PARSE(app, argc, argv);
  try {
    return terra::benchmark::Run(folder, quick);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "terra-speed: %s\n", error.what());
    return 1;
  }
}

#include "benchmark/speed/timing.h"

#include <map>

#include <benchmark/benchmark.h>

#include "terrain/require.h"

namespace terra::benchmark {
namespace {

// Keeps the medians and prints nothing.
class MedianReporter : public ::benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type == Run::RT_Aggregate && run.aggregate_name == "median") {
        medians_[run.run_name.function_name] = run.GetAdjustedCPUTime();
      }
    }
  }

  double median(const std::string& name) const {
    const auto found = medians_.find(name);
    TERRA_REQUIRE(found != medians_.end());
    return found->second;
  }

 private:
  std::map<std::string, double> medians_;
};

// There is no other way to ask for it than a flag.
void InterleaveAtRandom() {
  char program[] = "terra-speed";
  char flag[] = "--benchmark_enable_random_interleaving=true";
  char* arguments[] = {program, flag, nullptr};
  int count = 2;
  ::benchmark::Initialize(&count, arguments);
}

}  // namespace

std::vector<TimedSample> TimeInterleaved(const std::vector<TimedWork>& works,
                                         int rounds) {
  TERRA_REQUIRE(rounds >= 2);  // Else there is no median.
  InterleaveAtRandom();
  ::benchmark::ClearRegisteredBenchmarks();
  for (const TimedWork& work : works) {
    ::benchmark::RegisterBenchmark(work.name.c_str(),
                                   [&work](::benchmark::State& state) {
                                     for (auto _ : state) work.run();
                                   })
        ->Iterations(work.calls)
        ->Repetitions(rounds)
        ->Unit(::benchmark::kMicrosecond);
  }
  MedianReporter reporter;
  ::benchmark::RunSpecifiedBenchmarks(&reporter);
  std::vector<TimedSample> samples;
  for (const TimedWork& work : works) {
    samples.push_back({work.name, reporter.median(work.name), work.amount});
  }
  return samples;
}

}  // namespace terra::benchmark

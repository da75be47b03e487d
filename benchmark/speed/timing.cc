#include "benchmark/speed/timing.h"

#include <time.h>

#include <algorithm>

namespace terra::benchmark {
namespace {

double ThreadMicroseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 +
         static_cast<double>(now.tv_nsec) * 1e-3;
}

double Median(std::vector<double> values) {
  const auto middle =
      values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<TimedSample> TimeInterleaved(const std::vector<TimedWork>& works,
                                         int rounds) {
  std::vector<std::vector<double>> times(works.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const double start = ThreadMicroseconds();
      for (int call = 0; call < works[i].calls; ++call) {
        works[i].run();
      }
      times[i].push_back((ThreadMicroseconds() - start) / works[i].calls);
    }
  }
  std::vector<TimedSample> samples;
  for (std::size_t i = 0; i < works.size(); ++i) {
    samples.push_back(
        {works[i].name, Median(std::move(times[i])), works[i].amount});
  }
  return samples;
}

}  // namespace terra::benchmark

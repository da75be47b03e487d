#include "benchmark/speed/timing.h"

#include <time.h>

#include <algorithm>
#include <cmath>

namespace terra::benchmark {
namespace {

double ThreadMicroseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 +
         static_cast<double>(now.tv_nsec) * 1e-3;
}

std::vector<double>& SeriesNamed(const std::string& name,
                                 std::vector<TimedSeries>& series) {
  const auto found =
      std::find_if(series.begin(), series.end(), [&](const TimedSeries& s) {
        return s.name == name;
      });
  if (found != series.end()) {
    return found->microseconds;
  }
  return series.emplace_back(TimedSeries{name, {}}).microseconds;
}

}  // namespace

double TimedSeries::Quantile(double q) const {
  std::vector<double> sorted = microseconds;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(q * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

void TimeInterleaved(const std::vector<TimedWork>& works, int rounds,
                     std::vector<TimedSeries>& series) {
  std::vector<TimedSeries> runs;
  for (int round = 0; round < rounds; ++round) {
    for (const TimedWork& work : works) {
      const double start = ThreadMicroseconds();
      work.run();
      SeriesNamed(work.name, runs).push_back(ThreadMicroseconds() - start);
    }
  }
  for (const TimedSeries& run : runs) {
    SeriesNamed(run.name, series).push_back(run.Quantile(0.5));
  }
}

}  // namespace terra::benchmark

#pragma once

#include <functional>
#include <string>
#include <vector>

namespace terra::benchmark {

/// A piece of work under a name. Its result must be used by the caller, so that
/// no compiler can leave it out.
struct TimedWork {
  std::string name;
  std::function<void()> run;
};

/// Times of one piece of work over all maps, in microseconds, one per map.
struct TimedSeries {
  std::string name;
  std::vector<double> microseconds;

  double Quantile(double q) const;  ///< Nearest rank. Pre: not empty.
};

/// Runs the works in turn, `rounds` times (A B C, A B C, ...), so that what
/// else the machine does falls on all of them; adds each one's median of this
/// thread's CPU time to its series, found by name.
void TimeInterleaved(const std::vector<TimedWork>& works, int rounds,
                     std::vector<TimedSeries>& series);

}  // namespace terra::benchmark

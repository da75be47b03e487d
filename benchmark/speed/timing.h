#pragma once

#include <functional>
#include <string>
#include <vector>

namespace terra::benchmark {

/// A piece of work under a name. `run` checks or uses its result, so that no
/// compiler can leave the work out.
struct TimedWork {
  std::string name;
  std::function<void()> run;
  /// Calls timed together, for work too short for the clock.
  int calls = 1;
  /// What one call works on, in cells or bytes; for rates.
  double amount = 1;
};

/// Time of one call.
struct TimedSample {
  std::string name;
  double microseconds = 0;
  double amount = 1;
};

/// Times works with Google Benchmark, each `rounds` times, in a random order of
/// all rounds of all works (its random interleaving), so that whatever else the
/// machine does falls on all of them. Returns each one's median, in the order
/// of the works. Units: this thread's CPU time. Pre: rounds >= 2.
std::vector<TimedSample> TimeInterleaved(const std::vector<TimedWork>& works,
                                         int rounds);

}  // namespace terra::benchmark

#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace terra::benchmark {

/// Tells on stderr how far long work has come: done, rate, time left. On a
/// terminal one line that is rewritten, elsewhere a line now and then.
///
/// Threads: Advance from any.
class Progress {
 public:
  /// `done` of `total` are finished already (a run that is resumed).
  Progress(std::string title, std::int64_t total, std::int64_t done = 0);
  /// Ends the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more is finished.
  void Advance();

 private:
  using Clock = std::chrono::steady_clock;

  void Print(Clock::time_point now);

  const std::string title_;
  const std::int64_t total_;
  const std::int64_t resumed_;
  const Clock::time_point begin_;
  const bool terminal_;
  std::mutex mutex_;
  std::int64_t done_;
  Clock::time_point next_print_;
  bool printed_ = false;
};

/// Returns "12 s", "3 min 20 s" or "2 h 5 min".
std::string FormatDuration(double seconds);

}  // namespace terra::benchmark

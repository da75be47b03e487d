#pragma once

#include <cstdint>
#include <limits>

namespace terra::verifier {

/// Bounds how many bytes a second go into a journal: `burst` at once after a
/// pause, `bytes_per_s` on average. So no second takes more than their sum.
///
/// Time: `now_us` is any steady clock; one that runs back counts as standing.
/// Threads: one.
class JournalBudget {
 public:
  struct Limits {
    std::int64_t bytes_per_s = 0;
    std::int64_t burst = 0;
  };

  explicit JournalBudget(const Limits& limits)
      : limits_(limits), left_(limits.burst) {}

  /// Takes so many bytes if as many as `leaves` are left for others afterwards;
  /// returns whether it did.
  bool Take(std::int64_t bytes, std::int64_t leaves, std::int64_t now_us);

 private:
  void Refill(std::int64_t now_us);

  Limits limits_;
  std::int64_t left_;
  std::int64_t now_us_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace terra::verifier

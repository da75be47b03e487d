#pragma once

#include <cstdint>

#include "terrain/require.h"

namespace terra::benchmark {

/// Inclusive bounds.
struct IntRange {
  int low = 0;
  int high = 0;
};

/// Random integers that are the same on every machine.
/// Source: SplitMix64 (Steele, Lea and Flood 2014).
class IntegerRandom {
 public:
  explicit IntegerRandom(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits.
  std::uint64_t Next() {
    state_ += kGamma;
    return Mix(state_);
  }

  /// As after `n` more calls of Next.
  void Skip(std::uint64_t n) { state_ += n * kGamma; }

  /// Uniform in [low, high], but for a bias below 2^-32 per unit of the span.
  int In(IntRange range) {
    TERRA_REQUIRE(range.low <= range.high);
    const auto span =
        static_cast<std::uint64_t>(std::int64_t{range.high} - range.low + 1);
    const std::uint64_t offset = ((Next() >> 32) * span) >> 32;
    return range.low + static_cast<int>(offset);
  }
  int In(int low, int high) { return In(IntRange{low, high}); }

  /// Scrambles a number; a bijection.
  static constexpr std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9e3779b97f4a7c15;

  std::uint64_t state_;
};

}  // namespace terra::benchmark

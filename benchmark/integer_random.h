#pragma once

#include <cstdint>

#include "base/split_mix.h"
#include "terrain/require.h"

namespace terra::benchmark {

/// Inclusive bounds.
struct IntRange {
  int low = 0;
  int high = 0;
};

/// Random integers that are the same on every machine.
class IntegerRandom : public SplitMix64 {
 public:
  using SplitMix64::SplitMix64;

  /// Uniform in [low, high], but for a bias below 2^-32 per unit of the span.
  int In(IntRange range) {
    TERRA_REQUIRE(range.low <= range.high);
    const auto span =
        static_cast<std::uint64_t>(std::int64_t{range.high} - range.low + 1);
    const std::uint64_t offset = ((Next() >> 32) * span) >> 32;
    return range.low + static_cast<int>(offset);
  }
  int In(int low, int high) { return In(IntRange{low, high}); }
};

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <optional>

#include "benchmark/metrics.h"
#include "benchmark/statistics.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// How two methods differ on the cases that both have.
struct Comparison {
  std::int64_t cases = 0;
  std::int64_t only_first_lower = 0;
  std::int64_t only_second_lower = 0;
  double mcnemar_p = 1;  ///< Exact, two-sided, of FIR.
  /// First minus second; absent without common gaps, and unless both have a
  /// fallback.
  std::optional<Estimate> mogr_difference;
};

/// Other repeats than 0 are left out. `cases` are at most as many as either
/// has; of `at_once` of them 32 bytes each are kept, for more the rows are read
/// once more. The interval is of a sample (ClusteredMean) then. Errors: those
/// of the readers.
Result<Comparison> ComparePaired(const ScoreReader& first,
                                 const CountingRule& first_rule,
                                 const ScoreReader& second,
                                 const CountingRule& second_rule,
                                 std::int64_t cases = 0,
                                 std::int64_t at_once = kMaxCasesKept);

}  // namespace terra::benchmark

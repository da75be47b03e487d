#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "terrain/result.h"

namespace terra::benchmark {

/// What a merge found.
struct MergeCounts {
  std::int64_t rows = 0;
  std::int64_t missing = 0;  ///< Of the run's case list times repeats.
};

/// Puts the shards of a run into one folder: rows in the order of the shards,
/// interleaved as the cases were dealt. `out` then is a run as if it had been
/// made in one piece.
///
/// Errors: folders of different runs; a row that two shards have; `out` holds
/// results already.
Result<MergeCounts> MergeRuns(const std::vector<std::string>& shards,
                              const std::string& out);

}  // namespace terra::benchmark

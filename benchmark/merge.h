#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "terrain/result.h"

namespace terra::benchmark {

/// Puts the shards of a run into one folder, as if it had been made in one
/// piece. Returns the number of rows. Memory does not grow with them.
///
/// Errors: a shard that is missing or not finished (all such are named, nothing
/// is written); folders of different runs; a shard that is there twice; `out`
/// holds results already.
Result<std::int64_t> MergeRuns(const std::vector<std::string>& shards,
                               const std::string& out);

}  // namespace terra::benchmark

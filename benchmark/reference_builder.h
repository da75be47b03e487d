#pragma once

#include <cstdint>
#include <string>

#include "advisor/reference_pool.h"
#include "terrain/files/map_file.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// Seed of the pool that comes with the program: no released set's.
inline constexpr std::uint64_t kPoolSeed = 7'001;

/// Builds `count` pairs from generated maps, Easy and Hard in turn, the first
/// ones that qualify (advisor::MakeReferencePair).
///
/// Pre:    count >= 1.
/// Errors: `seed` is that of the released set, whose cases must stay unseen;
///         too few maps qualify.
Result<advisor::ReferencePool> BuildGeneratedPool(std::uint64_t seed,
                                                  int count);

/// The same from the cases of a dataset, for its legend, in its order; one pair
/// a map. Column `sequence` (RUGD) goes along.
/// `unknown`: of the dataset's ROS maps.
Result<advisor::ReferencePool> BuildDatasetPool(
    const std::string& folder, int count, const UnknownGround& unknown = {});

}  // namespace terra::benchmark

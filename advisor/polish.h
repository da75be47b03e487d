#pragma once

#include "advisor/corridor.h"
#include "advisor/refiners.h"

namespace terra::advisor {

/// Makes the best of a proposed route: clamps its waypoints to the map, adds
/// missing ends, and takes the optimum inside the corridor around it and the
/// baseline, or the proposal itself where that is valid and cheaper.
///
/// A proposal in the right place with sloppy coordinates so becomes a good one;
/// raw and polished results are to be reported apart.
/// Cost: at most the baseline's, and the proposal's where that is valid.
RefineOutput Polish(const RefineInput& input, const Route& proposal,
                    int half_width = kCorridorHalfWidth);

}  // namespace terra::advisor

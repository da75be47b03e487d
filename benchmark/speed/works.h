#pragma once

#include <vector>

#include "benchmark/speed/speed_case.h"
#include "benchmark/speed/timing.h"

namespace terra::benchmark {

/// Native searches in every form that this machine has, knowing nothing, with
/// the baseline's cost as upper bound, and with that of a lattice of their own,
/// beside the peers and the floor. All costs found must agree, or it ends as
/// for a bug. The graph libraries take up to 400 bytes a cell.
std::vector<TimedSample> TimeSearches(const SpeedCase& c, int rounds);

/// Searches for the worst cases, where some have no route: automatic choice and
/// textbook A*.
std::vector<TimedSample> TimeWorstCase(const SpeedCase& c, int rounds);

/// Lattice, verification, shortcut, and the whole deterministic chain.
std::vector<TimedSample> TimeChain(const SpeedCase& c, int rounds);

/// What carries maps and questions: tile digests, tile compression, the text
/// and pictures for an LLM.
std::vector<TimedSample> TimeData(const SpeedCase& c, int rounds);

}  // namespace terra::benchmark

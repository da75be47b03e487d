#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::benchmark {

/// How ends are chosen (docs/benchmark.md; the paper leaves it open).
inline constexpr int kRugdDraws = 200;
inline constexpr int kRugdEndDistance = 100;  ///< Cells, Euclidean.
inline constexpr int kRugdStride = 50;  ///< A lattice route must exist at it.

struct RugdEnds {
  Cell start;
  Cell goal;
};

/// Draws start and goal from hash(seed, frame name) alone: both in one
/// 8-connected passable component, kRugdEndDistance apart, joined by a lattice
/// route. Absent, with a reason, when kRugdDraws tries find none.
struct RugdDraw {
  std::optional<RugdEnds> ends;
  std::string reason;
};
RugdDraw DrawRugdEnds(const TerrainMap& map, std::uint64_t seed,
                      const std::string& frame_name);

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <string_view>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// What noise is put on the map that a model is shown.
struct NoiseOptions {
  double percent = 0;  ///< Of all cells that shall differ; 0 to 100.
  std::uint64_t seed = 0;
  std::string_view case_id;  ///< Noise is drawn from hash(seed, case_id).
  Cell start;                ///< Nothing changes within kNoiseFreeCells of
  Cell goal;                 ///< start or goal.
};

inline constexpr int kNoiseFreeCells = 5;
inline constexpr int kMinPatchSide = 10;
inline constexpr int kMaxPatchSide = 40;

/// Relabels square patches whole to another id of the map, one after the other,
/// until `percent` of all cells differ from the original. The patches of a
/// lower percentage are the first ones of a higher. Obstacles may appear and
/// vanish. Where that share cannot be reached (one terrain only, a tiny map),
/// it stops after a bounded number of draws.
/// Deterministic on every machine. The paper leaves the patches' size open.
TerrainMap WithNoise(const TerrainMap& map, const NoiseOptions& options);

}  // namespace terra::advisor

#pragma once

#include <cstdint>

#include "terrain/cell.h"
#include "terrain/raster.h"

namespace terra::benchmark {

/// Square maps made to be hard for searches, of the multiterrapath legend.
/// Corridors are one cell wide and of the given terrain.
struct WorstCase {
  ByteRaster ids;
  Cell start;
  Cell goal;
};

/// One corridor that fills the map, row by row, turning at alternate ends.
WorstCase RowSerpentine(int side, std::uint8_t ground);
/// The same, column by column.
WorstCase ColumnSerpentine(int side, std::uint8_t ground);
/// From the corner to the middle: walls in rings, one gap each.
WorstCase Spiral(int side, std::uint8_t ground);
/// A goal that cannot be reached, in a walled room on open ground.
WorstCase ClosedRoom(int side, std::uint8_t ground);
/// A terrain drawn for every cell (no obstacles), corner to corner.
WorstCase NoiseOfCosts(int side, std::uint64_t seed);

}  // namespace terra::benchmark

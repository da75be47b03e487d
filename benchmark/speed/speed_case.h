#pragma once

#include <string>
#include <vector>

#include "benchmark/map_generator.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::benchmark {

/// A query that works are timed on.
struct SpeedCase {
  std::string family;  ///< "easy", "hard" or the name of a worst case.
  int index = 0;       ///< Within its family.
  TerrainMap map;
  Cell start;
  Cell goal;
};

/// Generated cases of any side: the calibrated generator's scenes at a finer
/// resolution, all its lengths in proportion to the side. The number of
/// terrains is that of a 500 x 500 map.
SpeedCase MakeGeneratedCase(Subset subset, int index, int side);

/// Maps made to be hard for searches (worst_case_maps.h), 500 x 500 cells.
std::vector<SpeedCase> MakeWorstCases();

}  // namespace terra::benchmark

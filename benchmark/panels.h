#pragma once

#include <string>
#include <vector>

#include "benchmark/case_result.h"
#include "terrain/cell.h"
#include "terrain/files/dataset.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A picture of one case for people.
struct Panel {
  std::string caption;
  std::string png;
};

/// Draws a map with the grey lattice, the baseline in blue and, when there is
/// one, the final route in green, both with a light edge; start and goal as
/// discs. One pixel a cell.
std::string DrawPanelPng(const TerrainMap& map, const Route& baseline,
                         const Route& final_route, int stride);

/// Pictures of `per_group` cases of each group of a run: the ones at even
/// distances in the order of what was gained, the largest gain first. With a
/// folder of camera frames (RUGD; empty = none) the frame of a case's name,
/// with the same routes, stands above its map.
/// In memory are 16 bytes per accepted case.
/// Errors: the run, a map or a frame cannot be read; a frame of another size.
Result<std::vector<Panel>> MakePanels(const std::string& run_folder,
                                      const DatasetFolder& dataset,
                                      int per_group, const std::string& frames);

}  // namespace terra::benchmark

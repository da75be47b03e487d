#pragma once

#include <string>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::logger {

/// A route on a map of the page.
struct DrawnRoute {
  Route route;
  std::string color;  ///< As CSS has it.
};

/// Draws a map as an embedded PNG, at most 1,000 pixels a side, under SVG
/// polylines of routes, with start and goal.
std::string MapFigure(const TerrainMap& map,
                      const std::vector<DrawnRoute>& routes, Cell start,
                      Cell goal);

/// Names the terrains that are on a map, with their costs.
std::string TerrainKey(const TerrainMap& map);

}  // namespace terra::logger

#pragma once

#include <span>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/raster.h"
#include "terrain/search_result.h"

namespace terra::advisor {

/// The half width of the corridors that the benchmark speaks of. Units: cells.
inline constexpr int kCorridorHalfWidth = 25;

/// The cells of a map within a Chebyshev distance of some routes' rasters.
/// Memory: a byte per cell of the routes' bounding box.
/// Threads: immutable.
class Corridor {
 public:
  /// Pre: at least one waypoint, all inside the map; half_width >= 0. Segments
  ///      may cross obstacles: a corridor is about place, not about passage.
  Corridor(const TerrainMap& map, std::span<const Route> routes,
           int half_width);

  bool Contains(Cell c) const {
    return c.x >= origin_.x && c.y >= origin_.y && c.x < origin_.x + width() &&
           c.y < origin_.y + height() &&
           inside_(c.y - origin_.y, c.x - origin_.x) != 0;
  }
  /// The rectangle that holds it: origin and size, inside the map.
  Cell origin() const { return origin_; }
  int width() const { return static_cast<int>(inside_.cols()); }
  int height() const { return static_cast<int>(inside_.rows()); }

 private:
  Cell origin_;
  ByteRaster inside_;
};

/// Finds a cheapest 8-connected path that never leaves a corridor, by the
/// project's cost rule and the map's cost model. Costs are compared as
/// RoundedKeys; ties: SearchResult::cells, of the paths in the corridor.
/// Source: A*: Hart, Nilsson, Raphael 1968.
SearchResult SearchCorridor(const TerrainMap& map, const Corridor& corridor,
                            Cell start, Cell goal);

/// The same path as a route of few waypoints that stays in the corridor and
/// costs the same (or less, where a segment from corner to corner does).
/// Empty where there is no path.
Route RouteInCorridor(const TerrainMap& map, const Corridor& corridor,
                      Cell start, Cell goal);

}  // namespace terra::advisor

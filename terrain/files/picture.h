#pragma once

#include <string>
#include <vector>

#include "terrain/cell.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra {

/// Route colours, the same in every picture.
inline constexpr Color kBaselineColor = FromRgb(0x1F4FE0);
inline constexpr Color kCandidateColor = FromRgb(0x0A8F2E);

/// A route to draw.
struct PictureRoute {
  Route route;
  Color color = kBaselineColor;
  std::string label;  ///< In the legend box; empty = not listed.
};

/// What a picture shows besides the terrain.
struct PictureOptions {
  std::vector<PictureRoute> routes;  ///< Drawn in this order.
  std::vector<Cell> starts;          ///< A ring with an S.
  std::vector<Cell> goals;           ///< A ring with a G.
  /// A white page around the map: a frame, so that white ground ends somewhere,
  /// a margin for what lies on the border, the legend to the right.
  bool page = true;
  std::string caption;  ///< One line below the map; empty = none.
  /// Pixels per cell; 0 = small maps are enlarged to about 700 pixels, larger
  /// ones keep one pixel per cell.
  int scale = 0;
};

/// Draws the map in its legend's colours, routes over it with a light edge, and
/// writes a PNG. A route is drawn through its dense cells, so what is seen is
/// what is checked; parts outside the map are left out. Lines, markers and
/// letters grow with the picture, so that a large one can be read as a whole.
/// Errors: the file cannot be written; the picture would be larger than
/// TerrainMap::kMaxSide x 2 a side.
Status WritePicture(const TerrainMap& map, const PictureOptions& options,
                    const std::string& path);

}  // namespace terra

#pragma once

#include "advisor/picture.h"
#include "advisor/prompt.h"
#include "terrain/cell.h"
#include "terrain/legend.h"
#include "terrain/map.h"

namespace terra::advisor {

/// The baseline is drawn in this blue with a white edge, because terrain 3 of
/// the paper's palette is blue as well.
inline constexpr Color kRouteBlue = FromRgb(0x1F4FE0);

/// Chooses the scale: one pixel a cell; with axes two (more on maps of less
/// than 134 cells) and a margin for numbers, where that fits; an integer
/// reduction where the map does not fit.
PictureFrame ChooseFrame(int width_cells, int height_cells, bool axes);

/// Draws the map in its legend's colours with start (ring, S) and goal (square,
/// G), and a route over the terrain when there is one. A reduced map shows the
/// dearest terrain of each block, obstacles before all.
Picture DrawMap(const TerrainMap& map, const PictureFrame& frame, Cell start,
                Cell goal, const Route* route = nullptr);

/// Draws the two routes of a reference pair side by side, 8 pixels apart.
Picture DrawReferencePair(const TerrainMap& map, const Route& left,
                          const Route& right);

}  // namespace terra::advisor

#pragma once

#include <string>

#include "advisor/prompt.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// "5", "3.5", "obstacle": a terrain's cost as the texts write it.
std::string CostText(double cost);

/// "761.317893": a route's cost, always with six decimals.
std::string TotalText(double cost);

/// The legend: each terrain that the map's legend has, with colour and cost.
std::string LegendText(const Legend& legend);

/// Where each kind of ground lies: a line per connected area, with its cost and
/// extent; as a table also a cell inside of each.
/// Source: paper, Fig. terrain-path-description (content, not wording).
std::string TerrainText(const TerrainMap& map, bool as_table);

/// The baseline's raster points 1, 6, 11, ... and the last one, with the
/// terrain's cost at each, and its total cost.
/// Source: as TerrainText.
std::string BaselineText(const TerrainMap& map, const Route& baseline,
                         double baseline_cost);

/// The baseline's cost by stretch: successive cells of one terrain cost.
std::string StretchText(const TerrainMap& map, const Route& baseline);

/// Which cell a pixel of the named pictures shows, and what lies at the margin.
std::string PixelText(const PictureFrame& frame, const std::string& images);

}  // namespace terra::advisor

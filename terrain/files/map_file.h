#pragma once

#include <string>

#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra {

/// Where a map lies in the world, in the way of ROS map_server: the pose of the
/// lower left corner of the lower left cell. Units: metres, radians.
struct MapPlacement {
  double cell_size = 1;
  double origin_x = 0;
  double origin_y = 0;
  double origin_yaw = 0;

  friend bool operator==(const MapPlacement&, const MapPlacement&) = default;
};

/// How a map file is to be read.
struct MapFileOptions {
  /// A built-in legend's name or the path of a legend CSV; empty = the one of
  /// the format: multiterrapath for PNG, movingai, occupancy for ROS.
  std::string legend;
  CostModel cost_model;
};

/// What a map file holds. Only ROS yaml says where the map lies.
struct MapFile {
  TerrainMap map;
  MapPlacement placement;
};

/// Reads a terrain map. The format is found from the content (PNG, MovingAI) or
/// the name (.yaml, .yml):
///   8-bit grey PNG   the grey values are terrain ids
///   24-bit PNG       exact legend colours, never the nearest one
///   MovingAI .map    Sturtevant 2012; the legend's ids 0 to 4 are ground,
///                    swamp, water, trees, out of bounds
///   ROS map_server   .yaml with a .pgm or 8-bit grey .png; the legend's ids 0
///                    to 2 are free, occupied, unknown. `mode: scale` and `raw`
///                    need a legend; the grey values are then the ids
///
/// Limits: TerrainMap::kMaxSide cells a side, judged from the header before any
///         memory is taken for the picture.
/// Errors: name the file and where in it (line, or pixel and colour).
Result<MapFile> ReadMap(const std::string& path,
                        const MapFileOptions& options = {});

/// Writes the ids as an 8-bit grey PNG, which ReadMap reads back.
Status WriteIdPng(const TerrainMap& map, const std::string& path);

/// Writes the map in its legend's colours as a 24-bit PNG.
Status WriteColorPng(const TerrainMap& map, const std::string& path);

}  // namespace terra

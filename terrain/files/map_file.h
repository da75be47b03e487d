#pragma once

#include <string>
#include <string_view>
#include <vector>

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

/// What unknown ground costs, in maps that have such (ROS, mode trinary).
struct UnknownGround {
  enum class Rule {
    kFormat,  ///< The thresholds say what is unknown, the legend what it costs.
    kFree,    ///< As much as free ground.
    kCost,    ///< `cost`.
  };
  Rule rule = Rule::kFormat;
  double cost = kImpassable;

  friend bool operator==(const UnknownGround&, const UnknownGround&) = default;
};

/// Reads `impassable`, `free` or a cost. Errors: say what is taken.
Result<UnknownGround> ParseUnknownGround(std::string_view text);

/// The text that gives this rule; empty for kFormat.
std::string ToText(const UnknownGround& unknown);

/// How a map file is to be read.
struct MapFileOptions {
  /// A built-in legend's name or the path of a legend CSV; empty = the one of
  /// the format: multiterrapath for PNG, movingai, occupancy for ROS.
  std::string legend;
  CostModel cost_model;
  /// With another rule than kFormat the grey 205, with which map savers mark
  /// unknown ground, is unknown whatever the thresholds make of it, and the
  /// rule overrides the cost of the legend's id 2.
  UnknownGround unknown;
};

/// What a map file holds. Only ROS yaml says where the map lies.
struct MapFile {
  TerrainMap map;
  MapPlacement placement;
  /// What whoever reads the map should be told, once: sentences that begin with
  /// the file's name.
  std::vector<std::string> notices;
};

/// Reads a terrain map. The format is found from the content (PNG, MovingAI) or
/// the name (.yaml, .yml):
///   8-bit grey PNG   the grey values are terrain ids
///   24-bit PNG       exact legend colours, never the nearest one
///   MovingAI .map    Sturtevant 2012; the legend's ids 0 to 4 are ground,
///                    swamp, water, trees, out of bounds
///   ROS map_server   .yaml with a .pgm or any .png, of which the mean of the
///                    channels counts; the legend's ids 0 to 2 are free,
///                    occupied, unknown. `mode: scale` and `raw` need a legend;
///                    the grey values are then the ids
///
/// Limits: TerrainMap::kMaxSide cells a side, judged from the header before any
///         memory is taken for the picture.
/// Errors: name the file and where in it (line, or pixel and colour); a rule
///         for unknown ground where the format has none.
Result<MapFile> ReadMap(const std::string& path,
                        const MapFileOptions& options = {});

/// Writes the ids as an 8-bit grey PNG, which ReadMap reads back.
Status WriteIdPng(const TerrainMap& map, const std::string& path);

/// Writes the map in its legend's colours as a 24-bit PNG.
Status WriteColorPng(const TerrainMap& map, const std::string& path);

}  // namespace terra

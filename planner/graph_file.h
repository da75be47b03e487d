#pragma once

#include <string>

#include "planner/waypoint_graph.h"
#include "terrain/result.h"

namespace terra::planner {

/// Reads a waypoint graph from a folder with two CSV files:
///   nodes.csv  columns name,x,y; names are unique, at most 31 bytes; cells of
///              the map, 0 to TerrainMap::kMaxSide - 1, each used once
///   edges.csv  columns from,to: names of nodes; one row for both directions
/// Errors: name the file and line. Nothing of it depends on a map: edges that
///         cannot be driven are found when a route is planned.
Result<WaypointGraph> ReadWaypointGraph(const std::string& folder);

}  // namespace terra::planner

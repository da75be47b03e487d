#pragma once

#include <cstdint>
#include <vector>

#include "bus/channels.h"
#include "terrain/cell.h"
#include "terrain/result.h"

namespace terra::bus {

/// Puts a route into a message with num_waypoints, waypoint_x and waypoint_y.
/// Pre: at most kMaxWaypoints.
template <typename Message>
void SetWaypoints(Message& message, const Route& route) {
  TERRA_REQUIRE(route.size() <= kMaxWaypoints);
  message.num_waypoints = static_cast<std::int32_t>(route.size());
  message.waypoint_x.clear();
  message.waypoint_y.clear();
  for (const Cell& cell : route) {
    message.waypoint_x.push_back(cell.x);
    message.waypoint_y.push_back(cell.y);
  }
}

/// Takes the route out of a decoded message.
template <typename Message>
Route WaypointsOf(const Message& message) {
  Route route;
  route.reserve(message.waypoint_x.size());
  for (std::size_t i = 0; i < message.waypoint_x.size(); ++i) {
    route.push_back(Cell{message.waypoint_x[i], message.waypoint_y[i]});
  }
  return route;
}

/// A cell path as one direction per step, two to a byte, low half first:
/// 0 = +x, then clockwise on the screen to 7 = +x-y.
/// Source: chain code, Freeman 1961 (IRE Trans. Electronic Computers 10:2).
struct Chain {
  std::int32_t num_steps = 0;
  std::vector<std::uint8_t> bytes;
};

/// Pre: successive cells are 8-neighbours.
Chain EncodeChain(const CellPath& cells);

/// Errors: a direction above 7, bytes that do not fit the number of steps, or
/// an unused half that is not 0.
Result<CellPath> DecodeChain(Cell first, const Chain& chain);

}  // namespace terra::bus

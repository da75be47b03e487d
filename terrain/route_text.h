#pragma once

#include <string>
#include <string_view>

#include "terrain/cell.h"
#include "terrain/result.h"

namespace terra {

/// Writes a route the way it stands in answers, CSV cells and command lines:
/// "[(x, y), (x, y), ...]".
std::string FormatRoute(const Route& route);

/// Reads that form; white space is free. Errors name the position. Integers of
/// at most 9 digits only; at most `max_waypoints` of them.
Result<Route> ParseRoute(std::string_view text,
                         std::size_t max_waypoints = 1'000'000);

/// Reads a cell given as "X,Y" on the command line.
Result<Cell> ParsePoint(std::string_view text);

}  // namespace terra

#pragma once

#include <cstdint>
#include <string>

#include "cli/map_arguments.h"
#include "terrain/search_result.h"

namespace terra::cli {

/// What `terra plan` and `terra oracle` found.
struct FoundRoute {
  SearchStatus status = SearchStatus::kNoRoute;
  Route waypoints;
  double cost = kImpassable;
  std::int64_t expanded = 0;
  double seconds = 0;  ///< Of the search alone.
  std::string where;   ///< "there is no route from A to B" goes on with it.
};

/// Prints it as JSON or for people; where there is no route, JSON has nulls and
/// stderr says why. Returns the exit code.
int PrintFoundRoute(const FoundRoute& found, const ProblemArguments& problem,
                    const TerrainMap& map, bool json);

}  // namespace terra::cli

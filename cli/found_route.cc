#include "cli/found_route.h"

#include <iostream>

#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "terrain/files/csv.h"
#include "terrain/route_text.h"

namespace terra::cli {
namespace {

Error WhyNoRoute(const FoundRoute& found, const ProblemArguments& problem,
                 const TerrainMap& map) {
  const Status ends = CheckEnds(map, problem);
  if (!ends.ok()) return ends.error();
  TERRA_REQUIRE(found.status == SearchStatus::kNoRoute);
  return Error{ErrorCode::kNotFound, "there is no route from " +
                                         ToString(problem.start) + " to " +
                                         ToString(problem.goal) + found.where};
}

}  // namespace

int PrintFoundRoute(const FoundRoute& found, const ProblemArguments& problem,
                    const TerrainMap& map, bool json) {
  if (json) {
    const nlohmann::ordered_json text = {
        {"cost", JsonCost(found.cost)},
        {"waypoints", JsonRoute(found.waypoints)},
        {"expanded", found.expanded},
        {"seconds", found.seconds}};
    std::cout << text.dump() << "\n";
  }
  if (found.status != SearchStatus::kFound) {
    return Fail(WhyNoRoute(found, problem, map));
  }
  if (!json) {
    std::cout << "cost      " << FormatNumber(found.cost) << "\n"
              << "route     " << FormatRoute(found.waypoints) << "\n"
              << "expanded  " << found.expanded << "\n"
              << "seconds   " << found.seconds << "\n";
  }
  return kDone;
}

}  // namespace terra::cli

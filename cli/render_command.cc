#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "terrain/files/picture.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"

namespace terra::cli {
namespace {

struct RenderArguments {
  MapArguments map;
  std::vector<Route> routes;
  std::string out;
};

// Told apart also by colour-blind eyes; after the last the first comes again.
constexpr std::array<Color, 6> kRouteColors = {
    kBaselineColor,    kCandidateColor,   FromRgb(0xD55E00),
    FromRgb(0x9B30B0), FromRgb(0x111111), FromRgb(0xB8860B)};

std::string Label(std::size_t number, const RouteWalk& walk) {
  std::string label = "route " + std::to_string(number);
  if (!walk.feasible()) {
    return label + ": not feasible at " + ToString(walk.cell);
  }
  std::array<char, 48> cost{};
  std::snprintf(cost.data(), cost.size(), ": cost %.1f", walk.cost);
  return label + cost.data();
}

// Two routes are usually a baseline and what may replace it.
std::string Caption(const TerrainMap& map, const std::vector<Route>& routes) {
  if (routes.size() != 2) return "";
  const double first = WalkRoute(map, routes[0]).cost;
  const double second = WalkRoute(map, routes[1]).cost;
  if (!std::isfinite(first) || !std::isfinite(second)) return "";
  const double saving = SavingPercent(first, second);
  return Printed("route 2 costs %.1f %% %s than route 1", std::abs(saving),
                 saving < 0 ? "more" : "less");
}

void AddOnce(std::vector<Cell>& cells, Cell cell) {
  if (std::find(cells.begin(), cells.end(), cell) == cells.end()) {
    cells.push_back(cell);
  }
}

int RunRender(const RenderArguments& arguments) {
  const Result<TerrainMap> map = LoadMap(arguments.map);
  if (!map.ok()) return Fail(map.error());
  PictureOptions picture;
  for (const Route& route : arguments.routes) {
    const std::size_t index = picture.routes.size();
    picture.routes.push_back({route, kRouteColors[index % kRouteColors.size()],
                              Label(index + 1, WalkRoute(*map, route))});
    AddOnce(picture.starts, route.front());
    AddOnce(picture.goals, route.back());
  }
  picture.caption = Caption(*map, arguments.routes);
  const Status written = WritePicture(*map, picture, arguments.out);
  return written.ok() ? kDone : Fail(written.error());
}

void AddRoutesOption(CLI::App& command, std::vector<Route>& routes) {
  const auto read = [&routes](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      const Result<Route> route = ParseRoute(text);
      if (!route.ok()) {
        throw CLI::ValidationError("--route", route.error().message);
      }
      if (route->empty()) {
        throw CLI::ValidationError("--route", "the route has no waypoints");
      }
      routes.push_back(*route);
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--route", read, "Route to draw; may be given more than once")
      ->allow_extra_args(false)  // Or a text in brackets would be split.
      ->type_name("ROUTE");
}

}  // namespace

void AddRenderCommand(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand(
      "render", "Draw a map with its legend, and routes on it");
  const auto arguments = std::make_shared<RenderArguments>();
  AddMapOptions(command, arguments->map);
  AddRoutesOption(command, arguments->routes);
  command.add_option("--out", arguments->out, "Picture to write")
      ->required()
      ->type_name("P.png");
  command.footer(
      "The first route is blue, the second green.\n"
      "Example:\n"
      "  terra render --map park.png --route \"[(2, 2), (90, 40)]\" --out "
      "park-route.png");
  command.callback([arguments, &exit_code] {
    exit_code = RunRender(*arguments);
  });
}

}  // namespace terra::cli

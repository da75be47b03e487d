#include "cli/map_arguments.h"

#include <iostream>
#include <utility>

#include <CLI/CLI.hpp>

#include "bus/map_file_options.h"
#include "terrain/route_text.h"

namespace terra::cli {
namespace {

// What cannot be read on the command line is wrong usage.
template <typename T>
T ValueOrThrow(Result<T> parsed, const std::string& option) {
  if (!parsed.ok()) throw CLI::ValidationError(option, parsed.error().message);
  return std::move(*parsed);
}

Status CheckEnd(const TerrainMap& map, const std::string& name, Cell cell) {
  if (!map.Contains(cell)) {
    return Error{ErrorCode::kInvalid, name + " " + ToString(cell) +
                                          " is outside the map; x is 0 to " +
                                          std::to_string(map.width() - 1) +
                                          ", y is 0 to " +
                                          std::to_string(map.height() - 1)};
  }
  if (map.Passable(cell)) return Done{};
  const Terrain* terrain = map.legend().Find(map.ids()(cell.y, cell.x));
  const bool own = terrain->cost == kImpassable;
  return Error{ErrorCode::kInvalid,
               name + " " + ToString(cell) + " is on impassable ground (" +
                   (own ? terrain->name : "too near to an obstacle") +
                   "); choose another cell"};
}

}  // namespace

void AddCostModelOptions(CLI::App& command, CostModel& model) {
  const auto read = [&model](const std::string& text) {
    model.corner_cutting = text == "on";
  };
  command
      .add_option_function<std::string>(
          "--corner-cutting", read,
          "May a diagonal step pass between two blocked cells: on (default) or "
          "off")
      ->check(CLI::IsMember({"on", "off"}).description(""))
      ->type_name("on|off");
  command
      .add_option("--clearance", model.clearance_cells,
                  "Block cells within N cells of an obstacle")
      ->check(CLI::Range(0, TerrainMap::kMaxClearance))
      ->type_name("N");
}

void AddMapFileOptions(CLI::App& command, MapArguments& arguments) {
  command.add_option("--map", arguments.path, "Terrain map to read")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--legend", arguments.options.legend,
                  "multiterrapath, rugd, movingai, occupancy or a CSV file "
                  "id,name,cost,color (default: the map format's)")
      ->type_name("L");
}

void AddMapOptions(CLI::App& command, MapArguments& arguments) {
  AddMapFileOptions(command, arguments);
  bus::AddUnknownOption(command, arguments.options.unknown);
  AddCostModelOptions(command, arguments.options.cost_model);
}

void AddCellOption(CLI::App& command, const std::string& name, Cell& cell,
                   const std::string& description) {
  const auto read = [&cell, name](const std::string& text) {
    cell = ValueOrThrow(ParsePoint(text), name);
  };
  command.add_option_function<std::string>(name, read, description)
      ->required()
      ->type_name("X,Y");
}

CLI::Option* AddRouteOption(CLI::App& command, const std::string& name,
                            std::optional<Route>& route,
                            const std::string& description) {
  const auto read = [&route, name](const std::string& text) {
    route = ValueOrThrow(ParseRoute(text), name);
  };
  return command.add_option_function<std::string>(name, read, description)
      ->required()
      ->type_name("ROUTE");
}

void AddStrideOption(CLI::App& command, int& stride) {
  command
      .add_option("--stride", stride,
                  "Distance of lattice nodes in cells (default 50)")
      ->check(CLI::Range(1, TerrainMap::kMaxSide))
      ->type_name("N");
}

void AddEndOptions(CLI::App& command, ProblemArguments& arguments) {
  AddCellOption(command, "--start", arguments.start, "Start cell");
  AddCellOption(command, "--goal", arguments.goal, "Goal cell");
}

void AddProblemOptions(CLI::App& command, ProblemArguments& arguments) {
  AddMapOptions(command, arguments.map);
  AddEndOptions(command, arguments);
}

Result<TerrainMap> LoadMap(const MapArguments& arguments) {
  Result<MapFile> file = ReadMap(arguments.path, arguments.options);
  if (!file.ok()) return file.error();
  SayNotices(*file);
  return std::move(file->map);
}

void SayNotices(const MapFile& file) {
  for (const std::string& notice : file.notices) {
    std::cerr << "terra: " << notice << '\n';
  }
}

Status CheckEnds(const TerrainMap& map, const ProblemArguments& problem) {
  const Status start = CheckEnd(map, "start", problem.start);
  return start.ok() ? CheckEnd(map, "goal", problem.goal) : start;
}

}  // namespace terra::cli

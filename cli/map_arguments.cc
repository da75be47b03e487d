#include "cli/map_arguments.h"

#include <utility>

#include <CLI/CLI.hpp>

#include "terrain/route_text.h"

namespace terra::cli {
namespace {

Status CheckEnd(const TerrainMap& map, const std::string& name, Cell cell) {
  if (!map.Contains(cell)) {
    return Error{ErrorCode::kInvalid,
                 name + " " + ToString(cell) + " is outside the map; x is 0 to " +
                     std::to_string(map.width() - 1) + ", y is 0 to " +
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
  const std::map<std::string, bool> on_off = {{"on", true}, {"off", false}};
  command
      .add_option("--corner-cutting", model.corner_cutting,
                  "May a diagonal step pass between two blocked cells: on "
                  "(default) or off")
      ->transform(CLI::Transformer(on_off))
      ->check(CLI::IsMember(std::vector<std::string>{"0", "1"}))
      ->type_name("on|off");
  command
      .add_option("--clearance", model.clearance_cells,
                  "Block cells within N cells of an obstacle")
      ->check(CLI::Range(0, TerrainMap::kMaxClearance))
      ->type_name("N");
}

void AddMapOptions(CLI::App& command, MapArguments& arguments) {
  command.add_option("--map", arguments.path, "Terrain map to read")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--legend", arguments.options.legend,
                  "multiterrapath, rugd, movingai, occupancy or a CSV file "
                  "id,name,cost,color (default: the map format's)")
      ->type_name("L");
  AddCostModelOptions(command, arguments.options.cost_model);
}

void AddCellOption(CLI::App& command, const std::string& name, Cell& cell,
                   const std::string& description) {
  command
      .add_option_function<std::string>(
          name,
          [&cell, name](const std::string& text) {
            const Result<Cell> parsed = ParsePoint(text);
            if (!parsed.ok()) {
              throw CLI::ValidationError(name, parsed.error().message);
            }
            cell = *parsed;
          },
          description)
      ->required()
      ->type_name("X,Y");
}

void AddProblemOptions(CLI::App& command, ProblemArguments& arguments) {
  AddMapOptions(command, arguments.map);
  AddCellOption(command, "--start", arguments.start, "Start cell");
  AddCellOption(command, "--goal", arguments.goal, "Goal cell");
}

Result<TerrainMap> LoadProblem(const ProblemArguments& arguments) {
  Result<MapFile> file = ReadMap(arguments.map.path, arguments.map.options);
  if (!file.ok()) return file.error();
  const Status start = CheckEnd(file->map, "start", arguments.start);
  if (!start.ok()) return start.error();
  const Status goal = CheckEnd(file->map, "goal", arguments.goal);
  if (!goal.ok()) return goal.error();
  return std::move(file->map);
}

}  // namespace terra::cli

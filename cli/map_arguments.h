#pragma once

#include <optional>
#include <string>

#include "terrain/cell.h"
#include "terrain/files/map_file.h"
#include "terrain/result.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace terra::cli {

/// The cost model as options: --corner-cutting, --clearance.
void AddCostModelOptions(CLI::App& command, CostModel& model);

/// What every command that reads a map takes.
struct MapArguments {
  std::string path;
  MapFileOptions options;
};

/// Adds --map and --legend.
void AddMapFileOptions(CLI::App& command, MapArguments& arguments);

/// Adds --map, --legend, --unknown and the cost model.
void AddMapOptions(CLI::App& command, MapArguments& arguments);

/// Adds a required option of the form X,Y.
void AddCellOption(CLI::App& command, const std::string& name, Cell& cell,
                   const std::string& description);

/// Start and goal, and the map they lie on.
struct ProblemArguments {
  MapArguments map;
  Cell start;
  Cell goal;
};

/// Adds --start and --goal.
void AddEndOptions(CLI::App& command, ProblemArguments& arguments);

/// Adds the map's options, --start and --goal.
void AddProblemOptions(CLI::App& command, ProblemArguments& arguments);

/// Adds a required option that takes a route text; set only when it is given.
CLI::Option* AddRouteOption(CLI::App& command, const std::string& name,
                            std::optional<Route>& route,
                            const std::string& description);

/// Adds --stride of the baseline's lattice.
void AddStrideOption(CLI::App& command, int& stride);

/// Reads the map and says its notices on stderr.
Result<TerrainMap> LoadMap(const MapArguments& arguments);

/// Says on stderr what the user should know of a map.
void SayNotices(const MapFile& file);

/// Errors: start or goal is outside the map or impassable.
Status CheckEnds(const TerrainMap& map, const ProblemArguments& problem);

}  // namespace terra::cli

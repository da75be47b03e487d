#pragma once

#include <optional>

#include "cli/map_arguments.h"
#include "planner/coarse_lattice.h"
#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::cli {

/// The baseline of a command that improves one.
struct BaselineArguments {
  planner::LatticeOptions lattice;
  std::optional<Route> route;  ///< Instead of the lattice's.
};

/// Adds --stride and --baseline.
void AddBaselineOptions(CLI::App& command, BaselineArguments& arguments);

/// A feasible route and its cost.
struct Baseline {
  Route route;
  double cost = kImpassable;
};

/// Errors: the lattice has no route; the given one is not feasible.
Result<Baseline> FindBaseline(const TerrainMap& map,
                              const ProblemArguments& problem,
                              const BaselineArguments& arguments);

}  // namespace terra::cli

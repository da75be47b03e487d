#include "cli/baseline.h"

#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "verifier/verify.h"

namespace terra::cli {

void AddBaselineOptions(CLI::App& command, BaselineArguments& arguments) {
  AddStrideOption(command, arguments.lattice.stride);
  AddRouteOption(command, "--baseline", arguments.route,
                 "Baseline to improve (default: the lattice's)")
      ->required(false);
}

Result<Baseline> FindBaseline(const TerrainMap& map,
                              const ProblemArguments& problem,
                              const BaselineArguments& arguments) {
  Baseline baseline;
  if (arguments.route) {
    baseline.route = *arguments.route;
  } else {
    planner::LatticePlan plan = planner::PlanOnLattice(
        map, problem.start, problem.goal, arguments.lattice);
    if (!plan.found()) {
      return Error{ErrorCode::kNotFound,
                   "there is no baseline on the lattice of stride " +
                       std::to_string(arguments.lattice.stride) +
                       "; try a smaller --stride, or give a --baseline"};
    }
    baseline.route = std::move(plan.waypoints);
  }
  const verifier::RouteCheck check =
      verifier::CheckRoute(map, baseline.route, problem.start, problem.goal);
  if (!check.feasible()) {
    return Error{ErrorCode::kInvalid,
                 "the baseline is not feasible: " +
                     std::string(verifier::CodeName(check.code))};
  }
  baseline.cost = check.cost;
  return baseline;
}

}  // namespace terra::cli

#include <chrono>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/found_route.h"
#include "cli/output.h"
#include "planner/coarse_lattice.h"

namespace terra::cli {
namespace {

struct PlanArguments {
  ProblemArguments problem;
  planner::LatticeOptions lattice;
  bool json = false;
};

int RunPlan(const PlanArguments& arguments) {
  const ProblemArguments& problem = arguments.problem;
  const Result<TerrainMap> map = LoadMap(problem.map);
  if (!map.ok()) return Fail(map.error());
  const auto begin = std::chrono::steady_clock::now();
  planner::LatticePlan plan = planner::PlanOnLattice(
      *map, problem.start, problem.goal, arguments.lattice);
  const std::chrono::duration<double> took =
      std::chrono::steady_clock::now() - begin;
  const std::string where = " on the lattice of stride " +
                            std::to_string(arguments.lattice.stride) +
                            "; try a smaller --stride";
  return PrintFoundRoute({plan.status, std::move(plan.waypoints), plan.cost,
                          plan.expanded, took.count(), where},
                         problem, *map, arguments.json);
}

}  // namespace

void AddPlanCommand(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand(
      "plan", "Find the baseline: the cheapest route on a coarse lattice");
  const auto arguments = std::make_shared<PlanArguments>();
  AddProblemOptions(command, arguments->problem);
  AddStrideOption(command, arguments->lattice.stride);
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n"
      "  terra plan --map park.png --start 20,20 --goal 480,460 --stride 50");
  command.callback([arguments, &exit_code] {
    exit_code = RunPlan(*arguments);
  });
}

}  // namespace terra::cli

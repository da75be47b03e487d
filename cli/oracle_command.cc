#include <chrono>
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/found_route.h"
#include "cli/output.h"
#include "planner/optimum.h"
#include "terrain/segment.h"

namespace terra::cli {
namespace {

struct OracleArguments {
  ProblemArguments problem;
  bool json = false;
};

int RunOracle(const OracleArguments& arguments) {
  const ProblemArguments& problem = arguments.problem;
  const Result<TerrainMap> map = LoadMap(problem.map);
  if (!map.ok()) return Fail(map.error());
  const auto begin = std::chrono::steady_clock::now();
  const SearchResult found =
      planner::FindOptimum(*map, problem.start, problem.goal);
  const std::chrono::duration<double> took =
      std::chrono::steady_clock::now() - begin;
  Route corners = found.found() ? CornersOf(found.cells) : Route{};
  return PrintFoundRoute(
      {found.status, std::move(corners), found.cost, found.expanded,
       took.count(), ": impassable cells lie on every way"},
      problem, *map, arguments.json);
}

}  // namespace

void AddOracleCommand(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand(
      "oracle", "Find the native-resolution optimum: a search over all cells");
  const auto arguments = std::make_shared<OracleArguments>();
  AddProblemOptions(command, arguments->problem);
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n"
      "  terra oracle --map park.png --start 20,20 --goal 480,460 --json");
  command.callback([arguments, &exit_code] {
    exit_code = RunOracle(*arguments);
  });
}

}  // namespace terra::cli

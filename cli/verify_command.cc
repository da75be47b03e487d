#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bus/map_file_options.h"
#include "cli/commands.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "cli/verify_dataset.h"
#include "terrain/files/csv.h"
#include "terrain/route_text.h"
#include "verifier/verify.h"

namespace terra::cli {
namespace {

using verifier::Code;
using verifier::Comparison;
using verifier::RouteCheck;

struct VerifyArguments {
  ProblemArguments problem;
  std::optional<Route> baseline;  // Always given.
  std::string candidate;
  bool json = false;
};

// A candidate comes from an advisor: one that cannot be read is a verdict too.
Comparison Compare(const VerifyArguments& arguments, const TerrainMap& map) {
  const ProblemArguments& problem = arguments.problem;
  const Result<Route> candidate = ParseRoute(arguments.candidate);
  Comparison result = verifier::CompareRoutes(
      map, problem.start, problem.goal, *arguments.baseline,
      candidate.ok() ? *candidate : Route{});
  if (!candidate.ok()) {
    result.candidate.code = Code::kParseError;
    if (result.baseline.feasible()) result.code = Code::kParseError;
  }
  return result;
}

nlohmann::ordered_json JsonCheck(const RouteCheck& check) {
  nlohmann::ordered_json json = {{"code", verifier::CodeName(check.code)},
                                 {"segment", nullptr},
                                 {"cell", nullptr}};
  if (check.segment >= 0) {
    json["segment"] = check.segment;
    json["cell"] = {check.cell.x, check.cell.y};
  }
  return json;
}

// What would be deployed; an invalid baseline never is.
const char* DeployedRoute(const Comparison& result) {
  if (result.accepted()) return "candidate";
  return result.baseline.feasible() ? "baseline" : nullptr;
}

void PrintJson(const Comparison& result) {
  nlohmann::ordered_json json = {
      {"code", verifier::CodeName(result.code)},
      {"candidate_cost", JsonCost(result.candidate.cost)},
      {"baseline_cost", JsonCost(result.baseline.cost)},
      {"deployed", nullptr},
      {"candidate", JsonCheck(result.candidate)},
      {"baseline", JsonCheck(result.baseline)}};
  if (const char* deployed = DeployedRoute(result)) json["deployed"] = deployed;
  std::cout << json.dump() << "\n";
}

void PrintCheck(const char* name, const RouteCheck& check) {
  std::cout << name;
  if (check.feasible()) {
    std::cout << "cost " << FormatNumber(check.cost);
  } else {
    std::cout << verifier::CodeName(check.code);
    if (check.segment >= 0) {
      std::cout << " in segment " << check.segment << " at "
                << ToString(check.cell);
    }
  }
  std::cout << "\n";
}

void PrintText(const Comparison& result) {
  const char* deployed = DeployedRoute(result);
  std::cout << "verdict    " << verifier::CodeName(result.code) << "\n"
            << "deployed   " << (deployed ? deployed : "nothing") << "\n";
  PrintCheck("baseline   ", result.baseline);
  PrintCheck("candidate  ", result.candidate);
}

int RunVerify(const VerifyArguments& arguments) {
  const Result<TerrainMap> map = LoadMap(arguments.problem.map);
  if (!map.ok()) return Fail(map.error());
  const Comparison result = Compare(arguments, *map);
  if (arguments.json) {
    PrintJson(result);
  } else {
    PrintText(result);
  }
  return kDone;
}

}  // namespace

void AddVerifyCommand(CLI::App& app, int& exit_code) {
  CLI::App& command = *app.add_subcommand(
      "verify", "Check a route against the map and compare it with a baseline");
  const auto one = std::make_shared<VerifyArguments>();
  const auto many = std::make_shared<VerifyDatasetArguments>();

  const auto model = std::make_shared<CostModel>();
  AddCostModelOptions(command, *model);
  bus::AddUnknownOption(command, many->unknown);

  CLI::App& single = *command.add_option_group("one route");
  AddMapFileOptions(single, one->problem.map);
  AddEndOptions(single, one->problem);
  AddRouteOption(single, "--baseline", one->baseline,
                 "Baseline, as \"[(x, y), ...]\"");
  single.add_option("--candidate", one->candidate, "Proposed route, likewise")
      ->required()
      ->type_name("ROUTE");
  single.add_flag("--json", one->json, "Print JSON");

  CLI::App& dataset = *command.add_option_group("the routes of a dataset");
  AddVerifyDatasetOptions(dataset, *many);

  // What a group needs is asked for only where one of its options is given.
  single.needs(single.get_option("--map"));
  dataset.needs(dataset.get_option("--dataset"));
  command.footer(
      "The exit code is 0 for every verdict, also for a rejected candidate or "
      "a baseline\nthat cannot be driven (baseline_invalid).\n"
      "Examples:\n"
      "  terra verify --map park.png --start 2,2 --goal 90,40 \\\n"
      "      --baseline \"[(2, 2), (50, 50), (90, 40)]\" \\\n"
      "      --candidate \"[(2, 2), (90, 40)]\"\n"
      "  terra verify --dataset hard --routes routes.csv --out verdicts.csv");
  command.callback([one, many, model, &single, &dataset, &exit_code] {
    const bool is_single = single.count_all() > 0;
    if (is_single == (dataset.count_all() > 0)) {
      throw CLI::ValidationError(
          "verify",
          "give --map, --start, --goal, --baseline and --candidate, or "
          "--dataset, --routes and --out");
    }
    one->problem.map.options.cost_model = *model;
    one->problem.map.options.unknown = many->unknown;
    exit_code = is_single ? RunVerify(*one) : RunVerifyDataset(*many, *model);
  });
}

}  // namespace terra::cli

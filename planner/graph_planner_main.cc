// terra-graph-planner: a baseline planner on a graph of surveyed waypoints, in
// the place of terra-planner; the worked example of docs/own-planner.md.
// Reads the graph, again when its files change. Listens to the map,
// PLAN_REQUEST and DEPLOYED; publishes BASELINE, STATUS, CONFIG; exits when
// asked to (SIGINT, SIGTERM) or when it has no bus.
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "bus/process.h"
#include "planner/graph_planner_node.h"
#include "planner/waypoint_graph.h"

int main(int argc, char** argv) {
  std::string folder;
  int reach = terra::planner::kDefaultReach;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-graph-planner";
  spec.name = "planner";
  spec.description =
      "Plans on a graph of surveyed waypoints (nodes.csv, edges.csv): answers "
      "PLAN_REQUEST with BASELINE on LCM.\nexample: terra-graph-planner "
      "--graph examples/graph";
  spec.add_options = [&](CLI::App& app) {
    app.add_option("--graph", folder, "folder with nodes.csv and edges.csv")
        ->required();
    app.add_option("--reach", reach,
                   "cells from start or goal to a node, at most")
        ->check(CLI::Range(0, terra::planner::kMaxReach));
  };
  spec.make_node = [&](terra::bus::ProcessContext& context)
      -> terra::Result<std::unique_ptr<terra::bus::Node>> {
    auto node = std::make_unique<terra::planner::GraphPlannerNode>(
        context.name, folder, reach, context.out);
    const terra::Status loaded = node->Load();
    if (!loaded.ok()) return loaded.error();
    return std::unique_ptr<terra::bus::Node>(std::move(node));
  };
  return terra::bus::RunProcess(spec, argc, argv);
}

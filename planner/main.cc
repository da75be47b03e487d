// terra-planner: the baseline planner on a coarse lattice.
// Listens to the map, PLAN_REQUEST, DEPLOYED and VERDICT; publishes BASELINE,
// STATUS, CONFIG; exits when asked to (SIGINT, SIGTERM) or when it has no bus.
#include <CLI/CLI.hpp>

#include "bus/process.h"
#include "planner/coarse_lattice.h"
#include "planner/planner_node.h"
#include "terrain/map.h"

int main(int argc, char** argv) {
  terra::planner::LatticeOptions lattice;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-planner";
  spec.name = "planner";
  spec.description =
      "Plans on a coarse lattice over the terrain map: answers PLAN_REQUEST "
      "with BASELINE on LCM.\nexample: terra-planner --stride 50";
  spec.add_options = [&](CLI::App& app) {
    app.add_option("--stride", lattice.stride, "cells between lattice nodes")
        ->check(CLI::Range(1, terra::TerrainMap::kMaxSide));
  };
  spec.make_node = [&](terra::bus::ProcessContext& context)
      -> terra::Result<std::unique_ptr<terra::bus::Node>> {
    return std::unique_ptr<terra::bus::Node>(
        std::make_unique<terra::planner::PlannerNode>(
            context.name,
            [lattice](const terra::TerrainMap& map, terra::Cell start,
                      terra::Cell goal) {
              return terra::planner::PlanOnLattice(map, start, goal, lattice);
            },
            context.out));
  };
  return terra::bus::RunProcess(spec, argc, argv);
}

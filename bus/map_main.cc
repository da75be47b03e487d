// terra-map: the map server.
// Reads a map file, again when it or a file that belongs to it changes; listens
// to MAP_REQUEST, on the advice bus too; publishes MAP_HEADER, MAP_TILE,
// STATUS, CONFIG; exits when asked to (SIGINT, SIGTERM), or when the map cannot
// be read at start or there is no bus.
#include <chrono>
#include <map>

#include <CLI/CLI.hpp>

#include "bus/map_file_options.h"
#include "bus/map_node.h"
#include "bus/process.h"
#include "bus/subscribers.h"

int main(int argc, char** argv) {
  std::string path;
  terra::MapFileOptions options;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-map";
  spec.name = "map";
  spec.description =
      "Serves a terrain map on LCM, by tiles.\nexample: terra-map --map "
      "field.png --legend rugd";
  spec.add_options = [&](CLI::App& app) {
    app.add_option("--map", path, "PNG, MovingAI .map or ROS .yaml file");
    app.add_option("--legend", options.legend,
                   "built-in legend or CSV file (default: the format's)");
    terra::bus::AddUnknownOption(app, options.unknown);
    app.add_option("--corner-cutting", options.cost_model.corner_cutting,
                   "may a diagonal step pass between two blocked cells")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, bool>{{"on", true}, {"off", false}}));
    app.add_option("--clearance", options.cost_model.clearance_cells,
                   "cells this near to an impassable cell are blocked")
        ->check(CLI::Range(0, terra::TerrainMap::kMaxClearance));
    app.callback([&] {
      if (path.empty() && app["--print-config"]->count() == 0) {
        throw CLI::RequiredError("--map");
      }
    });
  };
  spec.make_node = [&](terra::bus::ProcessContext& context)
      -> terra::Result<std::unique_ptr<terra::bus::Node>> {
    auto node =
        std::make_unique<terra::bus::MapNode>(path, options, context.out);
    const terra::Status loaded = node->Load();
    if (!loaded) return loaded.error();
    // Here, since nobody waits for the map server.
    context.loop.Every(
        std::chrono::seconds(10),
        [map = node.get(), url = context.bus.lcm_url](terra::bus::Time) {
          map->NoteSubscribers(terra::bus::CountSubscribers(url));
        });
    return std::unique_ptr<terra::bus::Node>(std::move(node));
  };
  return terra::bus::RunProcess(spec, argc, argv);
}

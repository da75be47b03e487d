#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "terrain/files/map_file.h"

namespace terra::bus {

/// Adds --unknown, which every program that reads maps has.
inline void AddUnknownOption(CLI::App& app, UnknownGround& unknown) {
  const auto read = [&unknown](const std::string& text) {
    const Result<UnknownGround> parsed = ParseUnknownGround(text);
    if (!parsed.ok()) {
      throw CLI::ValidationError("--unknown", parsed.error().message);
    }
    unknown = *parsed;
  };
  app.add_option_function<std::string>(
         "--unknown", read,
         "unknown ground of a ROS map: impassable, free or its cost (default: "
         "as the file's thresholds and the legend say)")
      ->type_name("impassable|free|COST");
}

}  // namespace terra::bus

// Source: the ROS map_server file format (wiki.ros.org/map_server, nav2).
#include <array>
#include <cmath>
#include <filesystem>

#include <yaml-cpp/yaml.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/image.h"
#include "terrain/files/map_formats.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

enum class Mode { kTrinary, kGreyIsId };

struct Settings {
  std::string image;
  MapPlacement placement;
  Mode mode = Mode::kTrinary;
  bool negate = false;
  double occupied_threshold = 0;
  double free_threshold = 0;
};

Error Bad(const std::string& name, const std::string& what) {
  return Error{ErrorCode::kInvalid, name + ": " + what};
}

YAML::Node Get(const YAML::Node& yaml, const char* key) {
  YAML::Node value = yaml[key];
  if (!value)
    throw YAML::Exception(yaml.Mark(), std::string("no '") + key + "'");
  return value;
}

double GetNumber(const YAML::Node& yaml, const char* key, double low,
                 double high) {
  const YAML::Node node = Get(yaml, key);
  const auto value = node.as<double>();
  if (!(value >= low && value <= high)) {
    throw YAML::Exception(node.Mark(),
                          std::string("'") + key + "' is out of its range");
  }
  return value;
}

Result<Mode> GetMode(const YAML::Node& yaml, const std::string& name,
                     bool own_legend) {
  const auto mode = yaml["mode"].as<std::string>("trinary");
  if (mode == "trinary") return Mode::kTrinary;
  if (mode != "scale" && mode != "raw") {
    return Bad(name, "mode '" + mode + "': known are trinary, scale, raw");
  }
  if (!own_legend) {
    return Error{ErrorCode::kUnsupported,
                 name + ": mode '" + mode +
                     "' has graded values, whose costs only you know: give "
                     "--legend FILE.csv (id = grey value)"};
  }
  return Mode::kGreyIsId;
}

Result<Settings> ReadSettings(const YAML::Node& yaml, const std::string& name,
                              bool own_legend) {
  constexpr double kFar = 1e9;  // metres; beyond the earth
  Settings settings;
  settings.image = Get(yaml, "image").as<std::string>();
  settings.placement.cell_size = GetNumber(yaml, "resolution", 1e-6, kFar);
  const auto origin = Get(yaml, "origin").as<std::array<double, 3>>();
  for (const double value : origin) {
    if (!(std::abs(value) <= kFar))
      return Bad(name, "'origin' is out of range");
  }
  settings.placement.origin_x = origin[0];
  settings.placement.origin_y = origin[1];
  settings.placement.origin_yaw = origin[2];
  const Result<Mode> mode = GetMode(yaml, name, own_legend);
  if (!mode.ok()) return mode.error();
  settings.mode = *mode;
  if (settings.mode == Mode::kTrinary) {
    // Written as 0 or 1, by some programs as false or true.
    const auto negate = Get(yaml, "negate").as<std::string>();
    settings.negate = negate == "1" || negate == "true" || negate == "True";
    settings.occupied_threshold = GetNumber(yaml, "occupied_thresh", 0, 1);
    settings.free_threshold = GetNumber(yaml, "free_thresh", 0, 1);
    if (settings.free_threshold > settings.occupied_threshold) {
      return Bad(name, "'free_thresh' is above 'occupied_thresh'");
    }
  }
  return settings;
}

Result<Settings> ParseSettings(std::string_view text, const std::string& name,
                               bool own_legend) {
  try {
    const YAML::Node yaml = YAML::Load(std::string(text));
    if (!yaml.IsMap()) return Bad(name, "not a map_server yaml");
    return ReadSettings(yaml, name, own_legend);
  } catch (const YAML::Exception& error) {
    const int line = error.mark.line + 1;  // unknown: -1
    const std::string where = line > 0 ? ":" + std::to_string(line) : "";
    return Error{ErrorCode::kInvalid, name + where + ": " + error.msg};
  }
}

std::uint8_t OccupancyOf(std::uint8_t grey, const Settings& settings) {
  const double occupancy = (settings.negate ? grey : 255 - grey) / 255.0;
  if (occupancy > settings.occupied_threshold) return kOccupancyOccupied;
  if (occupancy < settings.free_threshold) return kOccupancyFree;
  return kOccupancyUnknown;
}

Result<ByteRaster> ReadGreyImage(const std::string& path) {
  const Result<std::string> bytes = ReadWholeFile(path, kMaxImageBytes);
  if (!bytes.ok()) return bytes.error();
  const Result<Pixels> image =
      IsPng(*bytes) ? DecodePng(*bytes, TerrainMap::kMaxSide, path)
                    : DecodePgm(*bytes, path);
  if (!image.ok()) return image.error();
  if (image->order != PixelOrder::kGrey) {
    return Error{ErrorCode::kUnsupported,
                 path + ": a map_server picture must be 8-bit greyscale"};
  }
  return ToRaster(*image);
}

}  // namespace

Result<RosMap> ParseRosMap(std::string_view text, const std::string& name,
                           bool own_legend) {
  const Result<Settings> settings = ParseSettings(text, name, own_legend);
  if (!settings.ok()) return settings.error();
  const std::filesystem::path image =
      std::filesystem::path(name).parent_path() / settings->image;
  Result<ByteRaster> ids = ReadGreyImage(image.string());
  if (!ids.ok()) return ids.error();
  if (settings->mode == Mode::kTrinary) {
    std::array<std::uint8_t, 256> id_of_grey{};
    for (std::size_t grey = 0; grey < id_of_grey.size(); ++grey) {
      id_of_grey[grey] =
          OccupancyOf(static_cast<std::uint8_t>(grey), *settings);
    }
    *ids = ids->unaryExpr([&](std::uint8_t grey) {
      return id_of_grey[grey];
    });
  }
  return RosMap{std::move(*ids), settings->placement};
}

}  // namespace terra

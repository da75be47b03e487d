#include "terrain/files/map_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "terrain/builtin_legends.h"
#include "terrain/files/ascii_case.h"
#include "terrain/files/csv.h"
#include "terrain/files/image.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_formats.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::size_t kMaxYamlBytes = 64 << 10;

// The legend that the user gave, else the format's.
Result<Legend> LegendFor(const MapFileOptions& options, const Legend& usual) {
  if (options.legend.empty()) return usual;
  return ReadLegend(options.legend);
}

Result<MapFile> MakeMapFile(Result<ByteRaster> ids, Legend legend,
                            const MapFileOptions& options,
                            const std::string& path,
                            const MapPlacement& placement = {},
                            std::vector<std::string> notices = {}) {
  if (!ids.ok()) return ids.error();
  Result<TerrainMap> map = TerrainMap::Create(
      std::move(*ids), std::move(legend), options.cost_model);
  if (!map.ok()) {
    return Error{map.error().code, path + ": " + map.error().message};
  }
  return MapFile{std::move(*map), placement, std::move(notices)};
}

// The legend with what the user said of unknown ground worked in.
Result<Legend> WithUnknownGround(Legend legend, const UnknownGround& unknown,
                                 const std::string& path) {
  if (unknown.rule == UnknownGround::Rule::kFormat) return legend;
  std::vector<Terrain> terrains = legend.terrains();
  const Terrain* free = legend.Find(kOccupancyFree);
  const auto row =
      std::find_if(terrains.begin(), terrains.end(), [](const Terrain& t) {
        return t.id == kOccupancyUnknown;
      });
  if (free == nullptr || row == terrains.end()) {
    return Error{ErrorCode::kInvalid,
                 path +
                     ": --unknown needs a legend with the ids 0 (free) and 2 "
                     "(unknown)"};
  }
  row->cost =
      unknown.rule == UnknownGround::Rule::kFree ? free->cost : unknown.cost;
  return Legend::Create(std::move(terrains));
}

Result<MapFile> ReadRosMap(const std::string& path,
                           const MapFileOptions& options) {
  const Result<std::string> text = ReadWholeFile(path, kMaxYamlBytes);
  if (!text.ok()) return text.error();
  Result<Legend> legend = LegendFor(options, OccupancyLegend());
  if (!legend.ok()) return legend.error();
  Result<RosMap> ros =
      ParseRosMap(*text, path, !options.legend.empty(), options.unknown);
  if (!ros.ok()) return ros.error();
  Result<Legend> full =
      WithUnknownGround(*std::move(legend), options.unknown, path);
  if (!full.ok()) return full.error();
  return MakeMapFile(std::move(ros->ids), std::move(*full), options, path,
                     ros->placement, std::move(ros->notices));
}

}  // namespace

Error NoUnknownGround(const std::string& place) {
  return {ErrorCode::kUnsupported,
          place +
              " there is no unknown ground for --unknown to decide on; the "
              "legend says what each id costs"};
}

Result<UnknownGround> ParseUnknownGround(std::string_view text) {
  using Rule = UnknownGround::Rule;
  if (text == "impassable") return UnknownGround{Rule::kCost, kImpassable};
  if (text == "free") return UnknownGround{Rule::kFree, kImpassable};
  const Result<double> cost = ParseNumber(text);
  if (cost.ok() && (*cost == kImpassable ||
                    (*cost >= Legend::kMinCost && *cost <= Legend::kMaxCost))) {
    return UnknownGround{Rule::kCost, *cost};
  }
  return Error{ErrorCode::kInvalid,
               "'" + std::string(text) +
                   "' is neither impassable nor free nor a cost within 0.001 "
                   "to 1000000"};
}

std::string ToText(const UnknownGround& unknown) {
  switch (unknown.rule) {
    case UnknownGround::Rule::kFormat:
      return "";
    case UnknownGround::Rule::kFree:
      return "free";
    case UnknownGround::Rule::kCost:
      break;
  }
  return unknown.cost == kImpassable ? "impassable"
                                     : FormatNumber(unknown.cost);
}

Result<MapFile> ReadMap(const std::string& path,
                        const MapFileOptions& options) {
  if (HasExtension(path, ".yaml") || HasExtension(path, ".yml")) {
    return ReadRosMap(path, options);
  }
  const Result<std::string> bytes = ReadWholeFile(path, kMaxImageBytes);
  if (!bytes.ok()) return bytes.error();
  const bool png = IsPng(*bytes);
  if (!png && !bytes->starts_with("type ")) {
    return Error{
        ErrorCode::kUnsupported,
        path +
            ": not a map that is known. Known are 8-bit PNG of terrain "
            "ids, 24-bit PNG in legend colours, MovingAI .map and ROS "
            "map_server .yaml"};
  }
  if (options.unknown.rule != UnknownGround::Rule::kFormat) {
    return NoUnknownGround(path + ": in this format");
  }
  Result<Legend> legend =
      LegendFor(options, png ? MultiTerraPathLegend() : MovingAiLegend());
  if (!legend.ok()) return legend.error();
  Result<ByteRaster> ids =
      png ? ParsePngMap(*bytes, *legend, path) : ParseMovingAiMap(*bytes, path);
  return MakeMapFile(std::move(ids), std::move(*legend), options, path);
}

Status WriteIdPng(const TerrainMap& map, const std::string& path) {
  return WritePng({map.ids().data(), map.width(), map.height()}, path);
}

Status WriteColorPng(const TerrainMap& map, const std::string& path) {
  std::array<Color, 256> color_of_id{};
  for (const Terrain& terrain : map.legend().terrains()) {
    color_of_id[static_cast<std::size_t>(terrain.id)] = terrain.color;
  }
  std::vector<std::uint8_t> rgb;
  const std::span ids(map.ids().data(),
                      static_cast<std::size_t>(map.ids().size()));
  rgb.reserve(3 * ids.size());
  for (const std::uint8_t id : ids) {
    const Color color = color_of_id[id];
    rgb.insert(rgb.end(), {color.r, color.g, color.b});
  }
  return WritePng({rgb.data(), map.width(), map.height(), PixelOrder::kRgb},
                  path);
}

}  // namespace terra

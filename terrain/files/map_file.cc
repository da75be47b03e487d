#include "terrain/files/map_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <utility>
#include <vector>

#include "terrain/builtin_legends.h"
#include "terrain/files/image.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_formats.h"
#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::size_t kMaxYamlBytes = 64 << 10;

bool HasExtension(const std::string& path,
                  std::initializer_list<std::string_view> extensions) {
  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) {
                   return static_cast<char>(std::tolower(c));
                 });
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](std::string_view extension) {
                       return lower.ends_with(extension);
                     });
}

// The legend that the user gave, else the format's.
Result<Legend> LegendFor(const MapFileOptions& options, const Legend& usual) {
  if (options.legend.empty()) return usual;
  return ReadLegend(options.legend);
}

Result<MapFile> MakeMapFile(Result<ByteRaster> ids, Legend legend,
                            const MapFileOptions& options,
                            const std::string& path,
                            const MapPlacement& placement = {}) {
  if (!ids.ok()) return ids.error();
  Result<TerrainMap> map = TerrainMap::Create(
      std::move(*ids), std::move(legend), options.cost_model);
  if (!map.ok()) {
    return Error{map.error().code, path + ": " + map.error().message};
  }
  return MapFile{std::move(*map), placement};
}

Result<MapFile> ReadRosMap(const std::string& path,
                           const MapFileOptions& options) {
  const Result<std::string> text = ReadWholeFile(path, kMaxYamlBytes);
  if (!text.ok()) return text.error();
  Result<Legend> legend = LegendFor(options, OccupancyLegend());
  if (!legend.ok()) return legend.error();
  Result<RosMap> ros = ParseRosMap(*text, path, !options.legend.empty());
  if (!ros.ok()) return ros.error();
  return MakeMapFile(std::move(ros->ids), std::move(*legend), options, path,
                     ros->placement);
}

}  // namespace

Result<MapFile> ReadMap(const std::string& path,
                        const MapFileOptions& options) {
  if (HasExtension(path, {".yaml", ".yml"})) {
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

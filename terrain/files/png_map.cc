#include <array>
#include <cstdio>
#include <unordered_map>

#include "terrain/files/image.h"
#include "terrain/files/map_formats.h"

namespace terra {
namespace {

std::string HexColor(std::uint32_t rgb) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%06X", rgb & 0xFFFFFFU);
  return text.data();
}

Error UnknownColor(const std::string& name, Cell cell, Color color) {
  return Error{ErrorCode::kInvalid,
               name + ": pixel " + ToString(cell) + " has colour " +
                   HexColor(ToRgb(color)) + " (RGB " + std::to_string(color.r) +
                   ", " + std::to_string(color.g) + ", " +
                   std::to_string(color.b) +
                   "), which the legend does not have; give the right one "
                   "with --legend, or correct the picture (colours are never "
                   "rounded to the nearest)"};
}

Result<ByteRaster> FromColors(const Pixels& image, const Legend& legend,
                              const std::string& name) {
  std::unordered_map<std::uint32_t, std::uint8_t> id_of_color;
  for (const Terrain& terrain : legend.terrains()) {
    id_of_color.emplace(ToRgb(terrain.color),
                        static_cast<std::uint8_t>(terrain.id));
  }
  ByteRaster ids(image.height, image.width);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* rgb = image.Row(y);
    for (int x = 0; x < image.width; ++x, rgb += 3) {
      const Color color{rgb[0], rgb[1], rgb[2]};
      const auto found = id_of_color.find(ToRgb(color));
      if (found == id_of_color.end()) {
        return UnknownColor(name, Cell{x, y}, color);
      }
      ids(y, x) = found->second;
    }
  }
  return ids;
}

}  // namespace

Result<ByteRaster> ParsePngMap(std::string_view bytes, const Legend& legend,
                               const std::string& name) {
  const Result<Pixels> image = DecodePng(bytes, TerrainMap::kMaxSide, name);
  if (!image.ok()) return image.error();
  if (image->order == PixelOrder::kGrey) return ToRaster(*image);
  return FromColors(*image, legend, name);
}

}  // namespace terra

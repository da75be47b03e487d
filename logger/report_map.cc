#include "logger/report_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/base64.h"
#include "logger/report_html.h"
#include "terrain/png/png.h"

namespace terra::logger {
namespace {

constexpr int kMaxSide = 1'000;

// One pixel for every stride-th cell.
Pixels Picture(const TerrainMap& map, int stride) {
  const int width = (map.width() + stride - 1) / stride;
  const int height = (map.height() + stride - 1) / stride;
  Pixels picture{width, height, PixelOrder::kRgb, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Terrain* terrain =
          map.legend().Find(map.ids()(y * stride, x * stride));
      const Color color = terrain != nullptr ? terrain->color : Color{};
      picture.bytes.insert(picture.bytes.end(), {color.r, color.g, color.b});
    }
  }
  return picture;
}

std::string Polyline(const DrawnRoute& drawn, double width) {
  std::string points;
  for (const Cell& cell : drawn.route) {
    points += Format("%.1f,%.1f ", cell.x + 0.5, cell.y + 0.5);
  }
  const std::string line = "<polyline fill=\"none\" points=\"" + points +
                           "\" stroke-linejoin=\"round\" stroke=\"";
  return line + Format("#fff\" stroke-width=\"%.2f\"/>", 1.9 * width) + line +
         drawn.color + Format("\" stroke-width=\"%.2f\"/>\n", width);
}

std::string Marker(Cell cell, const char* letter, double size) {
  const double x = cell.x + 0.5;
  const double y = cell.y + 0.5;
  return Format(
      "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"#fff\" "
      "stroke=\"#111\" stroke-width=\"%.2f\"/><text x=\"%.1f\" "
      "y=\"%.1f\" font-size=\"%.1f\" font-weight=\"700\" "
      "text-anchor=\"middle\">%s</text>\n",
      x, y, size, size / 5, x, y + 0.38 * size, 1.1 * size, letter);
}

}  // namespace

std::string MapFigure(const TerrainMap& map,
                      const std::vector<DrawnRoute>& routes, Cell start,
                      Cell goal) {
  const int side = std::max(map.width(), map.height());
  const int stride = (side + kMaxSide - 1) / kMaxSide;
  const std::string png = EncodePng(Picture(map, stride).view());
  const double unit = side / 300.0;
  std::string svg =
      Format(
          "<svg class=\"map\" viewBox=\"0 0 %d %d\" role=\"img\"><image "
          "width=\"%d\" height=\"%d\" preserveAspectRatio=\"none\" "
          "style=\"image-rendering:pixelated\" href=\"data:image/png;"
          "base64,",
          map.width(), map.height(), map.width(), map.height()) +
      Base64Encode(png) + "\"/>\n";
  for (const DrawnRoute& drawn : routes) svg += Polyline(drawn, 2.2 * unit);
  return svg + Marker(start, "S", 6 * unit) + Marker(goal, "G", 6 * unit) +
         "</svg>\n";
}

std::string TerrainKey(const TerrainMap& map) {
  std::array<bool, 256> there{};
  for (const std::uint8_t id : map.ids().reshaped()) there[id] = true;
  std::vector<std::pair<std::string, std::string>> colors;
  for (int id = 0; id < 256; ++id) {
    const Terrain* terrain = map.legend().Find(id);
    if (!there[static_cast<std::size_t>(id)] || terrain == nullptr) continue;
    const Color color = terrain->color;
    colors.emplace_back(
        Format("#%02x%02x%02x", color.r, color.g, color.b),
        Escape(terrain->name) + (std::isfinite(terrain->cost)
                                     ? ", cost " + Number(terrain->cost, 1)
                                     : ", impassable"));
  }
  return Key(colors);
}

}  // namespace terra::logger

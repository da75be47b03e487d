#include "advisor/pictures.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "advisor/canvas.h"
#include "advisor/pixel_font.h"
#include "terrain/require.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

constexpr int kTickMarginLeft = 32;
constexpr int kTickMarginTop = 14;
constexpr int kPairGap = 8;
constexpr int kMarkerRadius = 6;
/// With axes a map shows at least so many pixels along its longer side, at most
/// so many a cell: a tiny one would vanish under its numbers and markers.
constexpr int kLeastMapPixels = 400;
constexpr int kMaxPixelsPerCell = 40;

/// The colour of each terrain, and what a cell looks like that is blocked by
/// the clearance rule though its terrain is not.
struct Palette {
  std::array<Color, 256> color{};
  std::array<double, 256> cost{};
  int blocked_id = 0;

  explicit Palette(const Legend& legend) {
    for (const Terrain& terrain : legend.terrains()) {
      const auto id = static_cast<std::size_t>(terrain.id);
      color[id] = terrain.color;
      cost[id] = terrain.cost;
      if (terrain.cost == kImpassable) blocked_id = terrain.id;
    }
  }
  int ShownId(const TerrainMap& map, int x, int y) const {
    const int id = map.ids()(y, x);
    return map.classes()(y, x) == 0 &&
                   cost[static_cast<std::size_t>(id)] != kImpassable
               ? blocked_id
               : id;
  }
};

/// The dearest terrain of a block of cells; the lowest id of equal ones.
int DearestId(const TerrainMap& map, const Palette& palette, int x0, int y0,
              int side) {
  int dearest = palette.ShownId(map, x0, y0);
  for (int y = y0; y < std::min(y0 + side, map.height()); ++y) {
    for (int x = x0; x < std::min(x0 + side, map.width()); ++x) {
      const int id = palette.ShownId(map, x, y);
      const double more = palette.cost[static_cast<std::size_t>(id)];
      const double most = palette.cost[static_cast<std::size_t>(dearest)];
      if (more > most || (more == most && id < dearest)) dearest = id;
    }
  }
  return dearest;
}

int Reduced(int cells, int cells_per_pixel) {
  return (cells + cells_per_pixel - 1) / cells_per_pixel;
}

/// A cell's first pixel.
Cell PixelOf(const PictureFrame& frame, Cell cell) {
  return {
      frame.left_px + cell.x / frame.cells_per_pixel * frame.pixels_per_cell,
      frame.top_px + cell.y / frame.cells_per_pixel * frame.pixels_per_cell};
}

void DrawTerrain(Canvas& canvas, const TerrainMap& map,
                 const PictureFrame& frame) {
  const Palette palette(map.legend());
  const int columns = Reduced(map.width(), frame.cells_per_pixel);
  const int rows = Reduced(map.height(), frame.cells_per_pixel);
  const int side = frame.pixels_per_cell;
  for (int row = 0; row < rows; ++row) {
    std::uint8_t* first = canvas.At(frame.left_px, frame.top_px + row * side);
    std::uint8_t* pixel = first;
    for (int column = 0; column < columns; ++column) {
      const int id =
          frame.cells_per_pixel == 1
              ? palette.ShownId(map, column, row)
              : DearestId(map, palette, column * frame.cells_per_pixel,
                          row * frame.cells_per_pixel, frame.cells_per_pixel);
      const Color color = palette.color[static_cast<std::size_t>(id)];
      for (int copy = 0; copy < side; ++copy) {
        *pixel++ = color.r;
        *pixel++ = color.g;
        *pixel++ = color.b;
      }
    }
    const auto bytes = static_cast<std::size_t>(pixel - first);
    for (int copy = 1; copy < side; ++copy) {
      std::memcpy(canvas.At(frame.left_px, frame.top_px + row * side + copy),
                  first, bytes);
    }
  }
}

void DrawAxes(Canvas& canvas, const TerrainMap& map,
              const PictureFrame& frame) {
  if (frame.grid_cells == 0) {
    return;
  }
  for (int x = 0; x < map.width(); x += frame.grid_cells) {
    const int at = PixelOf(frame, {x, 0}).x;
    for (int y = frame.top_px; y < canvas.height(); ++y) canvas.Fade(at, y);
    canvas.Fill(at, frame.top_px - 4, 1, 4, kBlack);
    const std::string number = std::to_string(x);
    const int width = static_cast<int>(number.size()) * (kGlyphWidth + 1) - 1;
    canvas.Text(at - width / 2, 1, number);
  }
  for (int y = 0; y < map.height(); y += frame.grid_cells) {
    const int at = PixelOf(frame, {0, y}).y;
    for (int x = frame.left_px; x < canvas.width(); ++x) canvas.Fade(x, at);
    canvas.Fill(frame.left_px - 4, at, 4, 1, kBlack);
    canvas.Text(2, at - kGlyphHeight / 2, std::to_string(y));
  }
}

/// The pixels that a route's line passes: each cell's first one, and where
/// cells are large the middle ones and those between them.
std::vector<Cell> LineOf(const PictureFrame& frame, const Route& route) {
  const bool large = frame.pixels_per_cell > 2;
  const int half = large ? frame.pixels_per_cell / 2 : 0;
  std::vector<Cell> line;
  for (const Cell cell : RasterizeRoute(route)) {
    const Cell corner = PixelOf(frame, cell);
    const Cell at{corner.x + half, corner.y + half};
    while (large && !line.empty() && line.back() != at) {
      const Cell last = line.back();
      const Cell next{last.x + (at.x > last.x) - (at.x < last.x),
                      last.y + (at.y > last.y) - (at.y < last.y)};
      if (next == at) break;
      line.push_back(next);
    }
    line.push_back(at);
  }
  return line;
}

void DrawRoute(Canvas& canvas, const PictureFrame& frame, const Route& route) {
  const std::vector<Cell> line = LineOf(frame, route);
  const int width = std::min(frame.pixels_per_cell, 2);
  for (const int edge : {2, 1}) {  // The white edge first, then the line.
    for (const Cell at : line) {
      canvas.Fill(at.x - edge, at.y - edge, width + 2 * edge, width + 2 * edge,
                  edge == 2 ? kWhite : kRouteBlue);
    }
  }
}

enum class Marker { kStart, kGoal };

/// Draws a ring or square around a cell, black with a white edge, the cell
/// itself black, and the letter beside it.
void DrawMarker(Canvas& canvas, const PictureFrame& frame, Cell cell,
                Marker marker) {
  const Cell at = PixelOf(frame, cell);
  const int half = frame.pixels_per_cell / 2;
  const Cell centre{at.x + half, at.y + half};
  // Around the whole cell, whose corners are 0.71 of its side away.
  const int radius = std::max(kMarkerRadius, frame.pixels_per_cell * 3 / 4 + 4);
  const int reach = radius + 2;
  const int inside = (radius - 1) * (radius - 1);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      // Squared, for both markers: half a pixel more or less is a side apart.
      const int d = marker == Marker::kStart
                        ? dx * dx + dy * dy
                        : std::max(std::abs(dx), std::abs(dy)) *
                              std::max(std::abs(dx), std::abs(dy));
      if (d <= inside - 2 || d > reach * reach) continue;
      const bool line = d >= inside + 5 && d <= (radius + 1) * (radius + 1) + 1;
      canvas.Fill(centre.x + dx, centre.y + dy, 1, 1, line ? kBlack : kWhite);
    }
  }
  canvas.Fill(at.x, at.y, frame.pixels_per_cell, frame.pixels_per_cell, kBlack);
  constexpr int kBoxWidth = kGlyphWidth + 4;
  constexpr int kBoxHeight = kGlyphHeight + 4;
  const bool right = centre.x + reach + kBoxWidth < canvas.width();
  const int box_x = right ? centre.x + reach : centre.x - reach - kBoxWidth + 1;
  const int box_y = std::clamp(centre.y - kBoxHeight / 2, 0,
                               std::max(0, canvas.height() - kBoxHeight));
  canvas.Fill(box_x, box_y, kBoxWidth, kBoxHeight, kBlack);
  canvas.Fill(box_x + 1, box_y + 1, kBoxWidth - 2, kBoxHeight - 2, kWhite);
  canvas.Text(box_x + 2, box_y + 2, marker == Marker::kStart ? "S" : "G");
}

/// Ticks at a round distance, at most about a dozen along the longer side.
int GridDistance(int cells) {
  for (const int distance : {1, 2, 5, 10, 20, 50, 100, 200}) {
    if (cells <= 12 * distance) return distance;
  }
  return 500;
}

}  // namespace

PictureFrame ChooseFrame(int width_cells, int height_cells, bool axes) {
  TERRA_REQUIRE(width_cells > 0 && height_cells > 0);
  PictureFrame frame;
  if (axes) {
    frame.left_px = kTickMarginLeft;
    frame.top_px = kTickMarginTop;
    frame.grid_cells = GridDistance(std::max(width_cells, height_cells));
    if (2 * width_cells + frame.left_px <= kMaxPictureSide &&
        2 * height_cells + frame.top_px <= kMaxPictureSide) {
      frame.pixels_per_cell =
          std::clamp(kLeastMapPixels / std::max(width_cells, height_cells), 2,
                     kMaxPixelsPerCell);
      return frame;
    }
  }
  while (Reduced(width_cells, frame.cells_per_pixel) + frame.left_px >
             kMaxPictureSide ||
         Reduced(height_cells, frame.cells_per_pixel) + frame.top_px >
             kMaxPictureSide) {
    ++frame.cells_per_pixel;
  }
  return frame;
}

Picture DrawMap(const TerrainMap& map, const PictureFrame& frame, Cell start,
                Cell goal, const Route* route) {
  TERRA_REQUIRE(map.Contains(start) && map.Contains(goal));
  Picture picture =
      BlankPicture(frame.left_px + Reduced(map.width(), frame.cells_per_pixel) *
                                       frame.pixels_per_cell,
                   frame.top_px + Reduced(map.height(), frame.cells_per_pixel) *
                                      frame.pixels_per_cell);
  Canvas canvas(picture);
  DrawTerrain(canvas, map, frame);
  DrawAxes(canvas, map, frame);
  if (route != nullptr) {
    DrawRoute(canvas, frame, *route);
  }
  DrawMarker(canvas, frame, start, Marker::kStart);
  DrawMarker(canvas, frame, goal, Marker::kGoal);
  return picture;
}

Picture DrawReferencePair(const TerrainMap& map, const Route& left,
                          const Route& right) {
  PictureFrame frame;
  while (2 * Reduced(map.width(), frame.cells_per_pixel) + kPairGap >
             kMaxPictureSide ||
         Reduced(map.height(), frame.cells_per_pixel) > kMaxPictureSide) {
    ++frame.cells_per_pixel;
  }
  const int width = Reduced(map.width(), frame.cells_per_pixel);
  const int height = Reduced(map.height(), frame.cells_per_pixel);
  Picture pair = BlankPicture(2 * width + kPairGap, height);
  Canvas canvas(pair);
  canvas.Fill(width, 0, kPairGap, height, {128, 128, 128});
  int x = 0;
  for (const Route* route : {&left, &right}) {
    const Picture half =
        DrawMap(map, frame, route->front(), route->back(), route);
    const auto bytes = static_cast<std::size_t>(width) * 3;
    for (int y = 0; y < height; ++y) {
      std::memcpy(canvas.At(x, y),
                  half.rgb.data() + static_cast<std::size_t>(y) * bytes, bytes);
    }
    x = width + kPairGap;
  }
  return pair;
}

}  // namespace terra::advisor

#include "advisor/descriptions.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>

#include "advisor/terrain_regions.h"
#include "terrain/segment.h"
#include "terrain/steps.h"

namespace terra::advisor {
namespace {

constexpr std::size_t kSampleEvery = 5;

// to_chars, because the C library's printing follows the locale.
template <typename... Format>
std::string Number(double value, Format... format) {
  std::array<char, 64> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, format...);
  return std::string(text.data(), end.ptr);
}

std::string HexColor(Color color) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%06X", ToRgb(color));
  return text.data();
}

std::string Extent(const TerrainRegion& region) {
  return ToString(region.low) + " to " + ToString(region.high);
}

/// "(u - 32) / 2": a pixel's position as a cell's, of one axis.
std::string CellOfPixel(const PictureFrame& frame, const char* pixel,
                        int margin) {
  const int factor = std::max(frame.cells_per_pixel, frame.pixels_per_cell);
  std::string inside = pixel;
  if (margin > 0) inside += " - " + std::to_string(margin);
  if (factor == 1) return inside;
  if (margin > 0) inside = "(" + inside + ")";
  return frame.cells_per_pixel > 1 ? std::to_string(factor) + " * " + inside
                                   : inside + " / " + std::to_string(factor);
}

/// Which cell a pixel shows, where a pixel's position is not the cell's.
std::string CellOfPixelText(const PictureFrame& frame) {
  const bool reduced = frame.cells_per_pixel > 1;
  const std::string rounding =
      frame.pixels_per_cell > 1 ? ", both rounded down" : "";
  return "Pixel (u, v), counted from (0, 0) at the top left of the picture, "
         "shows " +
         std::string(reduced ? "the block whose top left cell is "
                             : "the cell ") +
         "x = " + CellOfPixel(frame, "u", frame.left_px) +
         ", y = " + CellOfPixel(frame, "v", frame.top_px) + rounding +
         ". Answer in cells, not in pixels.\n";
}

}  // namespace

std::string CostText(double cost) {
  return cost == kImpassable ? "obstacle" : Number(cost);
}

std::string TotalText(double cost) {
  return Number(cost, std::chars_format::fixed, 6);
}

std::string LegendText(const Legend& legend) {
  std::string text;
  for (const Terrain& terrain : legend.terrains()) {
    text += "- " + HexColor(terrain.color) + " " + terrain.name + ": " +
            (terrain.cost == kImpassable ? "obstacle, must not be entered"
                                         : "cost " + Number(terrain.cost)) +
            "\n";
  }
  return text;
}

std::string TerrainText(const TerrainMap& map, bool as_table) {
  const TerrainRegions regions = FindRegions(map);
  std::string text =
      as_table ? "area | cost | cells | extent | a cell inside\n" : "";
  int number = 0;
  for (const TerrainRegion& region : regions.large) {
    const std::string cells = std::to_string(region.cells);
    if (as_table) {
      text += std::to_string(++number) + " | " + CostText(region.cost) + " | " +
              cells + " | " + Extent(region) + " | " + ToString(region.inside) +
              "\n";
    } else {
      text += std::string("- ") +
              (region.cost == kImpassable ? "Obstacle"
                                          : "Cost " + Number(region.cost)) +
              ": about " + Extent(region) + ", " + cells + " cells\n";
    }
  }
  if (regions.small_regions > 0) {
    text +=
        "Smaller areas not listed: " + std::to_string(regions.small_regions) +
        ", together " + std::to_string(regions.small_cells) + " cells.\n";
  }
  return text;
}

std::string BaselineText(const TerrainMap& map, const Route& baseline,
                         double baseline_cost) {
  const CellPath cells = RasterizeRoute(baseline);
  std::string text;
  const auto add = [&](std::size_t i) {
    text += "#" + std::to_string(i + 1) + " " + ToString(cells[i]) + " cost " +
            CostText(map.Cost(cells[i])) + "\n";
  };
  for (std::size_t i = 0; i < cells.size(); i += kSampleEvery) {
    add(i);
  }
  if (!cells.empty() && (cells.size() - 1) % kSampleEvery != 0) {
    add(cells.size() - 1);
  }
  return text + "Total cost of the baseline: " + TotalText(baseline_cost) +
         "\n";
}

std::string StretchText(const TerrainMap& map, const Route& baseline) {
  const CellPath cells = RasterizeRoute(baseline);
  std::string text;
  for (std::size_t first = 1; first < cells.size();) {
    const double cost = map.Cost(cells[first]);
    double length = 0;
    std::size_t last = first;
    for (; last < cells.size() && map.Cost(cells[last]) == cost; ++last) {
      length += StepLength(cells[last - 1], cells[last]);
    }
    text += "- " + ToString(cells[first]) + " to " + ToString(cells[last - 1]) +
            ": length " + Number(length, std::chars_format::fixed, 1) +
            " at cost " + CostText(cost) + " = " +
            Number(length * cost, std::chars_format::fixed, 1) + "\n";
    first = last;
  }
  return text;
}

std::string PixelText(const PictureFrame& frame, const std::string& images) {
  std::string text;
  if (frame.cells_per_pixel > 1) {
    const std::string side = std::to_string(frame.cells_per_pixel);
    text += "In " + images + " one pixel stands for a block of " + side +
            " x " + side +
            " cells and shows the costliest terrain in it, obstacles before "
            "all.\n";
  } else if (frame.pixels_per_cell > 1) {
    const std::string side = std::to_string(frame.pixels_per_cell);
    text += "In " + images + " a cell is a square of " + side + " x " + side +
            " pixels.\n";
  } else {
    text += "In " + images + " one pixel is one cell.\n";
  }
  const bool margin = frame.left_px > 0 || frame.top_px > 0;
  if (margin) {
    text += "The map has a white margin of " + std::to_string(frame.left_px) +
            " pixels at its left and of " + std::to_string(frame.top_px) +
            " pixels above it.\n";
  }
  if (margin || frame.cells_per_pixel > 1 || frame.pixels_per_cell > 1) {
    text += CellOfPixelText(frame);
  }
  if (frame.grid_cells > 0) {
    const std::string next = std::to_string(frame.grid_cells);
    const std::string series =
        "0, " + next + ", " + std::to_string(2 * frame.grid_cells) + ", ...";
    text +=
        "The numbers in the margin are cell coordinates. Faint lines run "
        "along the left edge of the columns " +
        series + " and along the upper edge of the rows " + series + "\n";
  }
  return text;
}

}  // namespace terra::advisor

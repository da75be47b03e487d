#include "advisor/sim_answer.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "advisor/pictures.h"
#include "advisor/route_moves.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

/// What is to be known from the text.
struct Question {
  int width = 0;
  int height = 0;
  Cell start;
  Cell goal;
  std::vector<Terrain> terrains;
  double baseline_cost = kImpassable;  ///< Not told: nothing is good enough.
  bool may_retain = false;
};

/// The text after `label`; empty when it is not there.
std::string After(const std::string& text, std::string_view label) {
  const std::size_t at = text.find(label);
  return at == std::string::npos ? "" : text.substr(at + label.size(), 80);
}

/// Reads the legend's lines: "- #RRGGBB NAME: cost C" or "...: obstacle, ...".
std::vector<Terrain> ReadLegend(const std::string& text) {
  std::vector<Terrain> terrains;
  for (std::size_t at = text.find("\n- #"); at != std::string::npos;
       at = text.find("\n- #", at + 1)) {
    const std::string line =
        text.substr(at + 4, text.find('\n', at + 1) - at - 4);
    const std::size_t colon = line.rfind(": ");
    if (line.size() < 7 || colon == std::string::npos) continue;
    Terrain terrain;
    terrain.id = static_cast<int>(terrains.size());
    terrain.name = std::to_string(terrain.id);
    terrain.color = FromRgb(static_cast<std::uint32_t>(
        std::strtoul(line.substr(0, 6).c_str(), nullptr, 16)));
    double cost = 0;
    if (std::sscanf(line.c_str() + colon, ": cost %lf", &cost) == 1) {
      terrain.cost = cost;
    }
    terrains.push_back(terrain);
  }
  return terrains;
}

std::optional<Question> ReadQuestion(const std::string& text) {
  Question q;
  if (std::sscanf(After(text, "The map has ").c_str(),
                  "x from 0 to %d, y from 0 to %d", &q.width, &q.height) != 2 ||
      std::sscanf(After(text, "\nStart: ").c_str(), "(%d, %d)", &q.start.x,
                  &q.start.y) != 2 ||
      std::sscanf(After(text, "\nGoal: ").c_str(), "(%d, %d)", &q.goal.x,
                  &q.goal.y) != 2) {
    return std::nullopt;
  }
  ++q.width;
  ++q.height;
  if (q.width < 1 || q.height < 1 || q.width > TerrainMap::kMaxSide ||
      q.height > TerrainMap::kMaxSide) {
    return std::nullopt;
  }
  q.terrains = ReadLegend(text);
  std::sscanf(After(text, "\nTotal cost of the baseline: ").c_str(), "%lf",
              &q.baseline_cost);
  q.may_retain = text.find("\nYes\n") != std::string::npos;
  return q;
}

int ColorDistance(Color a, Color b) {
  const int r = a.r - b.r;
  const int g = a.g - b.g;
  const int blue = a.b - b.b;
  return r * r + g * g + blue * blue;
}

/// Reads the picture back, each cell as the terrain of the nearest colour.
std::optional<ByteRaster> ReadTerrain(const Question& q, const Picture& shown) {
  for (const bool axes : {false, true}) {
    const PictureFrame frame = ChooseFrame(q.width, q.height, axes);
    const auto pixels = [&frame](int cells, int margin) {
      return margin + (cells + frame.cells_per_pixel - 1) /
                          frame.cells_per_pixel * frame.pixels_per_cell;
    };
    if (shown.width != pixels(q.width, frame.left_px) ||
        shown.height != pixels(q.height, frame.top_px)) {
      continue;
    }
    ByteRaster ids(q.height, q.width);
    for (int y = 0; y < q.height; ++y) {
      for (int x = 0; x < q.width; ++x) {
        // The last pixel of a cell: grid lines lie on its first ones.
        const int px = frame.left_px +
                       x / frame.cells_per_pixel * frame.pixels_per_cell +
                       frame.pixels_per_cell - 1;
        const int py = frame.top_px +
                       y / frame.cells_per_pixel * frame.pixels_per_cell +
                       frame.pixels_per_cell - 1;
        const std::uint8_t* rgb =
            &shown.rgb[static_cast<std::size_t>(3 * (py * shown.width + px))];
        const Color color{rgb[0], rgb[1], rgb[2]};
        const auto nearest =
            std::min_element(q.terrains.begin(), q.terrains.end(),
                             [color](const Terrain& a, const Terrain& b) {
                               return ColorDistance(a.color, color) <
                                      ColorDistance(b.color, color);
                             });
        ids(y, x) = static_cast<std::uint8_t>(nearest->id);
      }
    }
    return ids;
  }
  return std::nullopt;
}

/// Replaces what a marker covers by the terrain nearest to it, ring by ring.
void EraseMarker(ByteRaster& ids, Cell centre) {
  constexpr int kReach = 20;
  const auto covered = [centre](Cell cell) {
    return std::max(std::abs(cell.x - centre.x), std::abs(cell.y - centre.y)) <=
           kReach;
  };
  const int width = static_cast<int>(ids.cols());
  const int height = static_cast<int>(ids.rows());
  std::deque<Cell> border;
  std::vector<char> known(static_cast<std::size_t>(ids.size()), 0);
  const auto at = [width](Cell cell) {
    return static_cast<std::size_t>(cell.y * width + cell.x);
  };
  for (int y = std::max(0, centre.y - kReach - 1);
       y <= std::min(height - 1, centre.y + kReach + 1); ++y) {
    for (int x = std::max(0, centre.x - kReach - 1);
         x <= std::min(width - 1, centre.x + kReach + 1); ++x) {
      if (covered({x, y})) continue;
      known[at({x, y})] = 1;
      border.push_back({x, y});
    }
  }
  while (!border.empty()) {
    const Cell from = border.front();
    border.pop_front();
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell to{from.x + step.x, from.y + step.y};
      if (to.x < 0 || to.y < 0 || to.x >= width || to.y >= height ||
          !covered(to) || known[at(to)] != 0) {
        continue;
      }
      known[at(to)] = 1;
      ids(to.y, to.x) = ids(from.y, from.x);
      border.push_back(to);
    }
  }
}

/// The map as far as the picture shows it.
std::optional<TerrainMap> SeenMap(const Question& q, const std::string& png) {
  const auto picture = DecodePicture(png);
  auto legend = Legend::Create(q.terrains);
  if (!picture || !legend) return std::nullopt;
  auto ids = ReadTerrain(q, *picture);
  if (!ids) return std::nullopt;
  EraseMarker(*ids, q.start);
  EraseMarker(*ids, q.goal);
  auto map = TerrainMap::Create(*std::move(ids), *std::move(legend), {});
  if (!map || !map->Contains(q.start) || !map->Contains(q.goal)) {
    return std::nullopt;
  }
  return *std::move(map);
}

}  // namespace

std::string SimulatedAnswer(const std::string& text, const std::string& png) {
  const auto question = ReadQuestion(text);
  const auto map = question ? SeenMap(*question, png) : std::nullopt;
  if (!map) return "I cannot read this question.";
  const SearchResult found =
      NativeSearch(*map, question->start, question->goal);
  if (!found.found()) return "I see no way from start to goal.";
  constexpr double kWorthIt = 0.995;
  if (question->may_retain && found.cost > kWorthIt * question->baseline_cost) {
    return "Yes";
  }
  const Route route =
      ThinWaypoints(CornersOf(found.cells), [&map](Cell from, Cell to) {
        return SegmentCost(*map, from, to);
      });
  return (question->may_retain ? "No. " : "") + FormatRoute(route);
}

}  // namespace terra::advisor

#include "terrain/files/picture.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <opencv2/imgproc.hpp>

#include "terrain/files/image.h"
#include "terrain/segment.h"

namespace terra {
namespace {

constexpr int kGoodSide = 700;
constexpr int kMaxScale = 64;
constexpr int kMaxPictureSide = 2 * TerrainMap::kMaxSide;
// A longer segment lies mostly outside any map; walking it would take for ever.
constexpr std::int64_t kMaxDrawnSteps = 4 * TerrainMap::kMaxSide;

const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);
const cv::Scalar kGray(120, 120, 120);

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.45;
constexpr int kRowHeight = 22;
constexpr int kMargin = 12;
constexpr int kSwatchWidth = 28;

cv::Scalar ToScalar(Color color) {
  return {1.0 * color.b, 1.0 * color.g, 1.0 * color.r};
}

int ScaleFor(const TerrainMap& map, int wanted) {
  if (wanted > 0) return wanted;
  const int longest = std::max(map.width(), map.height());
  return std::clamp(kGoodSide / longest, 1, kMaxScale);
}

cv::Mat DrawTerrain(const TerrainMap& map, int scale) {
  cv::Mat cells(map.height(), map.width(), CV_8UC3);
  std::array<cv::Vec3b, 256> color_of_id{};
  for (const Terrain& terrain : map.legend().terrains()) {
    const Color c = terrain.color;
    color_of_id[static_cast<std::size_t>(terrain.id)] =
        cv::Vec3b(c.b, c.g, c.r);
  }
  for (int y = 0; y < map.height(); ++y) {
    auto* row = cells.ptr<cv::Vec3b>(y);
    for (int x = 0; x < map.width(); ++x) row[x] = color_of_id[map.ids()(y, x)];
  }
  cv::Mat image;
  cv::resize(cells, image, {}, scale, scale, cv::INTER_NEAREST);
  return image;
}

cv::Point CenterOf(Cell cell, int scale) {
  return {cell.x * scale + scale / 2, cell.y * scale + scale / 2};
}

using Line = std::vector<cv::Point>;

// The parts of a route inside the map, each a line through its cell centres.
std::vector<Line> LinesInside(const TerrainMap& map, const Route& route,
                              int scale) {
  std::vector<Line> lines(1);
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    if (ChebyshevDistance(route[i], route[i + 1]) > kMaxDrawnSteps) {
      lines.emplace_back();
      continue;
    }
    for (SegmentCells cells(route[i], route[i + 1]);; cells.Next()) {
      if (map.Contains(cells.cell())) {
        lines.back().push_back(CenterOf(cells.cell(), scale));
      } else if (!lines.back().empty()) {
        lines.emplace_back();
      }
      if (cells.done()) break;
    }
  }
  return lines;
}

int LineWidth(int scale) {
  return std::clamp(scale / 3, 2, 8);
}

void DrawRoute(cv::Mat& image, const TerrainMap& map, const PictureRoute& route,
               int scale) {
  const std::vector<Line> lines = LinesInside(map, route.route, scale);
  const int width = LineWidth(scale);
  cv::polylines(image, lines, false, kWhite, width + 2, cv::LINE_AA);
  cv::polylines(image, lines, false, ToScalar(route.color), width, cv::LINE_AA);
}

void DrawMarker(cv::Mat& image, cv::Point center, const char* letter) {
  constexpr int kRadius = 9;
  cv::circle(image, center, kRadius, kWhite, cv::FILLED, cv::LINE_AA);
  cv::circle(image, center, kRadius, kBlack, 2, cv::LINE_AA);
  const cv::Size size = cv::getTextSize(letter, kFont, kFontScale, 1, nullptr);
  cv::putText(image, letter,
              {center.x - size.width / 2, center.y + size.height / 2}, kFont,
              kFontScale, kBlack, 1, cv::LINE_AA);
}

void DrawMarkers(cv::Mat& image, const TerrainMap& map,
                 const PictureOptions& options, int scale) {
  for (const Cell cell : options.starts) {
    if (map.Contains(cell)) DrawMarker(image, CenterOf(cell, scale), "S");
  }
  for (const Cell cell : options.goals) {
    if (map.Contains(cell)) DrawMarker(image, CenterOf(cell, scale), "G");
  }
}

// One row of the box beside the map.
struct BoxRow {
  enum class Kind { kTerrain, kRoute, kMarker };
  Kind kind = Kind::kTerrain;
  std::string text;
  Color color;
  const char* letter = "";
};

std::string TerrainText(const Terrain& terrain) {
  if (terrain.cost == kImpassable) return terrain.name + "  (impassable)";
  std::array<char, 32> cost{};
  std::snprintf(cost.data(), cost.size(), "%.6g", terrain.cost);
  return terrain.name + "  " + cost.data();
}

// Terrains that the map has, with their cost; then routes, start and goal.
std::vector<BoxRow> BoxRows(const TerrainMap& map,
                            const PictureOptions& options) {
  std::array<bool, 256> on_map{};
  for (const std::uint8_t id : map.ids().reshaped()) on_map[id] = true;
  std::vector<BoxRow> rows;
  for (const Terrain& terrain : map.legend().terrains()) {
    if (!on_map[static_cast<std::size_t>(terrain.id)]) continue;
    rows.push_back(
        {BoxRow::Kind::kTerrain, TerrainText(terrain), terrain.color});
  }
  for (const PictureRoute& route : options.routes) {
    if (route.label.empty()) continue;
    rows.push_back({BoxRow::Kind::kRoute, route.label, route.color});
  }
  if (!options.starts.empty()) {
    rows.push_back({BoxRow::Kind::kMarker, "start", {}, "S"});
  }
  if (!options.goals.empty()) {
    rows.push_back({BoxRow::Kind::kMarker, "goal", {}, "G"});
  }
  return rows;
}

void DrawBoxRow(cv::Mat& box, const BoxRow& row, int top) {
  const int middle = top + kRowHeight / 2;
  const int right = kMargin + kSwatchWidth;
  switch (row.kind) {
    case BoxRow::Kind::kTerrain: {
      const cv::Rect swatch(kMargin, top + 3, kSwatchWidth, kRowHeight - 6);
      cv::rectangle(box, swatch, ToScalar(row.color), cv::FILLED);
      cv::rectangle(box, swatch, kGray, 1);
      break;
    }
    case BoxRow::Kind::kRoute:
      cv::line(box, {kMargin, middle}, {right, middle}, ToScalar(row.color), 3,
               cv::LINE_AA);
      break;
    case BoxRow::Kind::kMarker:
      DrawMarker(box, {kMargin + kSwatchWidth / 2, middle}, row.letter);
      break;
  }
  cv::putText(box, row.text, {right + kMargin, middle + 5}, kFont, kFontScale,
              kBlack, 1, cv::LINE_AA);
}

cv::Mat DrawBox(const std::vector<BoxRow>& rows, int min_height) {
  int text_width = 0;
  for (const BoxRow& row : rows) {
    text_width = std::max(
        text_width,
        cv::getTextSize(row.text, kFont, kFontScale, 1, nullptr).width);
  }
  const int height = 2 * kMargin + kRowHeight * static_cast<int>(rows.size());
  cv::Mat box(std::max(height, min_height),
              3 * kMargin + kSwatchWidth + text_width, CV_8UC3, kWhite);
  int top = kMargin;
  for (const BoxRow& row : rows) {
    DrawBoxRow(box, row, top);
    top += kRowHeight;
  }
  return box;
}

cv::Mat Beside(const cv::Mat& left, const cv::Mat& right) {
  cv::Mat both(std::max(left.rows, right.rows), left.cols + right.cols, CV_8UC3,
               kWhite);
  left.copyTo(both(cv::Rect(0, 0, left.cols, left.rows)));
  right.copyTo(both(cv::Rect(left.cols, 0, right.cols, right.rows)));
  return both;
}

}  // namespace

Status WritePicture(const TerrainMap& map, const PictureOptions& options,
                    const std::string& path) {
  const int scale = ScaleFor(map, options.scale);
  const std::int64_t longest = std::max(map.width(), map.height());
  if (longest * scale > kMaxPictureSide) {
    return Error{ErrorCode::kUnsupported,
                 path + ": " + std::to_string(scale) +
                     " pixels per cell make a picture of more than " +
                     std::to_string(kMaxPictureSide) +
                     " pixels a side; choose a smaller scale"};
  }
  cv::Mat image = DrawTerrain(map, scale);
  for (const PictureRoute& route : options.routes) {
    DrawRoute(image, map, route, scale);
  }
  DrawMarkers(image, map, options, scale);
  if (options.legend) {
    image = Beside(image, DrawBox(BoxRows(map, options), image.rows));
  }
  return WritePng({image.data, image.cols, image.rows, PixelOrder::kBgr}, path);
}

}  // namespace terra

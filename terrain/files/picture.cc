#include "terrain/files/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
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

// How large lines and letters are. Lengths are for a picture of kGoodSide
// pixels; a larger one, which is seen smaller, has larger ones.
class Size {
 public:
  explicit Size(double factor) : factor_(factor) {}

  static Size ForPictureOf(int longest_side) {
    return Size(std::max(1.0, longest_side / double{kGoodSide}));
  }

  // Of a length given for kGoodSide.
  int Pixels(double length) const {
    return static_cast<int>(std::lround(length * factor_));
  }
  double factor() const { return factor_; }
  double font_scale() const { return 0.45 * factor_; }
  int pen() const { return Pixels(1); }
  int row_height() const { return Pixels(22); }
  int margin() const { return Pixels(14); }
  int swatch_width() const { return Pixels(28); }
  int marker_radius() const { return Pixels(9); }

 private:
  double factor_;
};

cv::Size TextSize(const std::string& text, const Size& size) {
  return cv::getTextSize(text, kFont, size.font_scale(), size.pen(), nullptr);
}

void DrawText(cv::Mat& image, const std::string& text, cv::Point at,
              const Size& size) {
  cv::putText(image, text, at, kFont, size.font_scale(), kBlack, size.pen(),
              cv::LINE_AA);
}

cv::Scalar ToScalar(Color color) {
  return {1.0 * color.b, 1.0 * color.g, 1.0 * color.r};
}

int ScaleFor(const TerrainMap& map, int wanted) {
  if (wanted > 0) return wanted;
  const int longest = std::max(map.width(), map.height());
  return std::clamp(kGoodSide / longest, 1, kMaxScale);
}

// Fills the picture, which is the map's size times the scale.
void DrawTerrain(const TerrainMap& map, cv::Mat& picture) {
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
  cv::resize(cells, picture, picture.size(), 0, 0, cv::INTER_NEAREST);
}

// Where the cells of a map are in a picture.
struct Place {
  int scale = 1;     // Pixels per cell.
  cv::Point corner;  // Of cell (0, 0).

  cv::Point CenterOf(Cell cell) const {
    return {corner.x + cell.x * scale + scale / 2,
            corner.y + cell.y * scale + scale / 2};
  }
};

using Line = std::vector<cv::Point>;

// The parts of a route inside the map, each a line through its cell centres.
std::vector<Line> LinesInside(const TerrainMap& map, const Route& route,
                              const Place& place) {
  std::vector<Line> lines(1);
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    if (ChebyshevDistance(route[i], route[i + 1]) > kMaxDrawnSteps) {
      lines.emplace_back();
      continue;
    }
    for (SegmentCells cells(route[i], route[i + 1]);; cells.Next()) {
      if (map.Contains(cells.cell())) {
        lines.back().push_back(place.CenterOf(cells.cell()));
      } else if (!lines.back().empty()) {
        lines.emplace_back();
      }
      if (cells.done()) break;
    }
  }
  return lines;
}

void DrawRoute(cv::Mat& image, const TerrainMap& map, const PictureRoute& route,
               const Place& place, const Size& size) {
  const std::vector<Line> lines = LinesInside(map, route.route, place);
  const int width = std::max(std::clamp(place.scale / 3, 2, 8), size.Pixels(2));
  cv::polylines(image, lines, false, kWhite, width + size.Pixels(2),
                cv::LINE_AA);
  cv::polylines(image, lines, false, ToScalar(route.color), width, cv::LINE_AA);
}

void DrawMarker(cv::Mat& image, cv::Point center, const char* letter,
                const Size& size) {
  const int radius = size.marker_radius();
  cv::circle(image, center, radius, kWhite, cv::FILLED, cv::LINE_AA);
  cv::circle(image, center, radius, kBlack, size.Pixels(2), cv::LINE_AA);
  const cv::Size text = TextSize(letter, size);
  DrawText(image, letter,
           {center.x - text.width / 2, center.y + text.height / 2}, size);
}

void DrawMarkers(cv::Mat& image, const TerrainMap& map,
                 const PictureOptions& options, const Place& place,
                 const Size& size) {
  for (const Cell cell : options.starts) {
    if (map.Contains(cell)) {
      DrawMarker(image, place.CenterOf(cell), "S", size);
    }
  }
  for (const Cell cell : options.goals) {
    if (map.Contains(cell)) {
      DrawMarker(image, place.CenterOf(cell), "G", size);
    }
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

void DrawBoxRow(cv::Mat& box, const BoxRow& row, int top, const Size& size) {
  const int height = size.row_height();
  const int middle = top + height / 2;
  const int width = size.swatch_width();
  switch (row.kind) {
    case BoxRow::Kind::kTerrain: {
      const cv::Rect swatch(0, top + height / 7, width,
                            height - 2 * height / 7);
      cv::rectangle(box, swatch, ToScalar(row.color), cv::FILLED);
      cv::rectangle(box, swatch, kGray, size.pen());
      break;
    }
    case BoxRow::Kind::kRoute:
      cv::line(box, {0, middle}, {width, middle}, ToScalar(row.color),
               size.Pixels(3), cv::LINE_AA);
      break;
    case BoxRow::Kind::kMarker:
      DrawMarker(box, {width / 2, middle}, row.letter, size);
      break;
  }
  DrawText(box, row.text, {width + size.margin(), middle + size.Pixels(5)},
           size);
}

// A long legend beside a low map has small letters rather than a high picture.
Size BoxSize(const Size& size, std::size_t rows, int height) {
  const int row_height = Size(1).row_height();
  const double needed = static_cast<double>(rows + 1) * row_height;
  const double fitting = height / needed;
  return Size(std::clamp(fitting, 1.0, size.factor()));
}

cv::Mat DrawBox(const std::vector<BoxRow>& rows, const Size& size) {
  int text_width = 0;
  for (const BoxRow& row : rows) {
    text_width = std::max(text_width, TextSize(row.text, size).width);
  }
  cv::Mat box(std::max(1, size.row_height() * static_cast<int>(rows.size())),
              size.swatch_width() + 2 * size.margin() + text_width, CV_8UC3,
              kWhite);
  int top = 0;
  for (const BoxRow& row : rows) {
    DrawBoxRow(box, row, top, size);
    top += size.row_height();
  }
  return box;
}

void DrawOnMap(cv::Mat& image, const TerrainMap& map,
               const PictureOptions& options, const Place& place,
               const Size& size) {
  for (const PictureRoute& route : options.routes) {
    DrawRoute(image, map, route, place, size);
  }
  DrawMarkers(image, map, options, place, size);
}

// From left to right a margin, the map in its frame, a margin, the legend; the
// caption below the map. Routes and markers may reach into the margin.
cv::Mat DrawPage(const TerrainMap& map, const PictureOptions& options,
                 int scale, const Size& size) {
  const cv::Size map_size(map.width() * scale, map.height() * scale);
  const std::vector<BoxRow> rows = BoxRows(map, options);
  const cv::Mat box =
      DrawBox(rows, BoxSize(size, rows.size(), map_size.height));
  const int margin = size.margin();
  const int caption_width =
      options.caption.empty()
          ? 0
          : 2 * margin + TextSize(options.caption, size).width;
  const int caption_height = options.caption.empty() ? 0 : size.row_height();
  cv::Mat page(
      2 * margin + caption_height + std::max(map_size.height, box.rows),
      std::max(2 * margin + map_size.width + box.cols, caption_width), CV_8UC3,
      kWhite);
  const Place place{scale, {margin, margin}};
  cv::Mat picture = page(cv::Rect(place.corner, map_size));
  DrawTerrain(map, picture);
  const int frame = size.Pixels(2);
  for (int i = 1; i <= frame; ++i) {
    cv::rectangle(page,
                  cv::Rect(margin - i, margin - i, map_size.width + 2 * i,
                           map_size.height + 2 * i),
                  kGray, 1);
  }
  DrawOnMap(page, map, options, place, size);
  box.copyTo(
      page(cv::Rect(2 * margin + map_size.width, margin, box.cols, box.rows)));
  DrawText(page, options.caption,
           {margin, margin + map_size.height + margin + size.Pixels(12)}, size);
  return page;
}

cv::Mat DrawPlain(const TerrainMap& map, const PictureOptions& options,
                  int scale, const Size& size) {
  cv::Mat image(map.height() * scale, map.width() * scale, CV_8UC3);
  DrawTerrain(map, image);
  DrawOnMap(image, map, options, Place{scale, {0, 0}}, size);
  return image;
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
  const Size size = Size::ForPictureOf(static_cast<int>(longest) * scale);
  const cv::Mat image = options.page ? DrawPage(map, options, scale, size)
                                     : DrawPlain(map, options, scale, size);
  return WritePng({image.data, image.cols, image.rows, PixelOrder::kBgr}, path);
}

}  // namespace terra

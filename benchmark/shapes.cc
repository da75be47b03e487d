#include "benchmark/shapes.h"

#include <algorithm>
#include <array>

namespace terra::benchmark {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << 30;
constexpr int kQuarter = kTurn / 4;

// cos and sin of 1/1024 turn, x 2^30.
constexpr std::int64_t kStepCosine = 1073721611;
constexpr std::int64_t kStepSine = 6588356;

constexpr std::int64_t RoundedShift(std::int64_t value) {
  return (value + kOne / 2) >> 30;
}

// A quarter of the wave, by turning a vector step by step. The error stays
// below 256 roundings of 2^-31.
constexpr std::array<std::int64_t, kQuarter + 1> MakeQuarter() {
  std::array<std::int64_t, kQuarter + 1> sine{};
  std::int64_t c = kOne;
  std::int64_t s = 0;
  for (int i = 0; i < kQuarter; ++i) {
    sine[static_cast<std::size_t>(i)] = s;
    const std::int64_t next = RoundedShift(c * kStepCosine - s * kStepSine);
    s = RoundedShift(s * kStepCosine + c * kStepSine);
    c = next;
  }
  sine[kQuarter] = kOne;
  return sine;
}
constexpr auto kSine = MakeQuarter();

int FloorMod(int value, int modulus) {
  const int rest = value % modulus;
  return rest < 0 ? rest + modulus : rest;
}

std::int64_t FloorDivide(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return quotient - ((a % b != 0) && ((a < 0) != (b < 0)) ? 1 : 0);
}

// The first cell whose centre is not left of x.
int FirstCell(std::int64_t x, int width) {
  const std::int64_t cell = FloorDivide(x + kFine - 1, kFine);
  return static_cast<int>(std::clamp<std::int64_t>(cell, 0, width));
}

}  // namespace

std::int64_t Sine(int angle) {
  const int a = FloorMod(angle, kTurn);
  const int half = a % (kTurn / 2);
  const int mirrored = half <= kQuarter ? half : kTurn / 2 - half;
  const std::int64_t value = kSine[static_cast<std::size_t>(mirrored)];
  return a < kTurn / 2 ? value : -value;
}

std::vector<FinePoint> Star::Outline(int margin) const {
  std::vector<FinePoint> outline;
  for (const Corner& corner : corners) {
    const std::int64_t length =
        std::int64_t{kFine} * radius * corner.percent / 100 + kFine * margin;
    outline.push_back(
        {kFine * center.x + RoundedShift(length * Cosine(corner.angle)),
         kFine * center.y + RoundedShift(length * Sine(corner.angle))});
  }
  return outline;
}

Star RandomStar(IntegerRandom& random, const StarRanges& ranges, int side) {
  Star star;
  star.center.x = random.In(0, side - 1);
  star.center.y = random.In(0, side - 1);
  star.radius = random.In(ranges.radius);
  const int corners = random.In(ranges.corners);
  const int first = random.In(0, kTurn - 1);
  for (int i = 0; i < corners; ++i) {
    const int sector = kTurn / corners;
    Star::Corner corner;
    corner.angle = first + i * kTurn / corners + random.In(0, sector * 2 / 3);
    corner.percent = random.In(ranges.percent);
    star.corners.push_back(corner);
  }
  return star;
}

std::vector<RowSpan> PolygonSpans(const std::vector<FinePoint>& outline,
                                  int width, int height) {
  std::vector<RowSpan> spans;
  std::vector<std::int64_t> crossings;
  for (int row = 0; row < height; ++row) {
    const std::int64_t y = std::int64_t{kFine} * row;
    crossings.clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const FinePoint& a = outline[i];
      const FinePoint& b = outline[(i + 1) % outline.size()];
      if ((a.y <= y) == (b.y <= y)) continue;
      crossings.push_back(a.x +
                          FloorDivide((y - a.y) * (b.x - a.x), b.y - a.y));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int from = FirstCell(crossings[i], width);
      const int to = FirstCell(crossings[i + 1], width);
      if (from < to) spans.push_back({row, from, to});
    }
  }
  return spans;
}

void FillSpans(ByteRaster& raster, const std::vector<RowSpan>& spans,
               std::uint8_t id) {
  for (const RowSpan& span : spans) {
    raster.row(span.y).segment(span.from, span.to - span.from) = id;
  }
}

void FillRibbon(ByteRaster& raster, const Ribbon& ribbon, std::uint8_t id) {
  const auto width = static_cast<int>(raster.cols());
  const auto height = static_cast<int>(raster.rows());
  const int along = ribbon.vertical ? height : width;
  const int across = ribbon.vertical ? width : height;
  for (int i = 0; i < along; ++i) {
    const int angle = ribbon.phase + ribbon.length_angle * i / along;
    const auto middle = static_cast<int>(
        ribbon.center + RoundedShift(ribbon.amplitude * Sine(angle)));
    const int from = std::clamp(middle - ribbon.half_width, 0, across);
    const int to = std::clamp(middle + ribbon.half_width + 1, 0, across);
    if (ribbon.vertical) {
      raster.row(i).segment(from, to - from) = id;
    } else {
      raster.col(i).segment(from, to - from) = id;
    }
  }
}

}  // namespace terra::benchmark

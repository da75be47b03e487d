#pragma once

#include <cstdint>
#include <vector>

#include "benchmark/integer_random.h"
#include "terrain/cell.h"
#include "terrain/raster.h"

namespace terra::benchmark {

/// Shapes in integers alone, so that a map has the same cells on any machine:
/// no floating point, no libm.

/// Angles are in 1/1024 turn, clockwise on the map (+y is down).
inline constexpr int kTurn = 1024;

/// Returns sine x 2^30 for any angle.
std::int64_t Sine(int angle);
inline std::int64_t Cosine(int angle) {
  return Sine(angle + kTurn / 4);
}

/// A point in 1/16 cell; the centre of cell (x, y) is (16 x, 16 y).
struct FinePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;
};
inline constexpr int kFine = 16;

/// A polygon that every ray from its centre leaves once: one corner per sector
/// of equal angle, each at a share of the radius.
struct Star {
  struct Corner {
    int angle = 0;
    int percent = 100;  ///< Of the radius.
  };
  Cell center;
  int radius = 0;  ///< Cells.
  std::vector<Corner> corners;

  /// The outline with the radius enlarged by `margin` cells.
  std::vector<FinePoint> Outline(int margin = 0) const;
};

/// How stars are drawn.
struct StarRanges {
  IntRange radius;
  IntRange corners;
  IntRange percent;
};
Star RandomStar(IntegerRandom& random, const StarRanges& ranges, int side);

/// A band along a sine wave across the map: from top to bottom, or from left to
/// right. Units: cells, but for angles.
struct Ribbon {
  bool vertical = true;
  int center = 0;
  int half_width = 0;
  int amplitude = 0;
  int phase = 0;
  int length_angle = 0;  ///< The wave's angle from one edge to the other.
};

/// The cells [from, to) of one row.
struct RowSpan {
  int y = 0;
  int from = 0;
  int to = 0;
};

/// The cells of a width x height raster whose centre lies inside, even-odd
/// rule. Source: scan-line filling (Wylie, Romney, Evans and Erdahl 1967).
std::vector<RowSpan> PolygonSpans(const std::vector<FinePoint>& outline,
                                  int width, int height);
void FillSpans(ByteRaster& raster, const std::vector<RowSpan>& spans,
               std::uint8_t id);
void FillRibbon(ByteRaster& raster, const Ribbon& ribbon, std::uint8_t id);

}  // namespace terra::benchmark

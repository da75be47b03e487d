#include "benchmark/shapes.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "terrain/cell.h"

namespace terra::benchmark {
namespace {

std::set<Cell> CellsOf(const std::vector<RowSpan>& spans) {
  std::set<Cell> cells;
  for (const RowSpan& span : spans) {
    for (int x = span.from; x < span.to; ++x) cells.insert({x, span.y});
  }
  return cells;
}

TEST(IntegerRandom, IsSplitMix64) {
  // The published first outputs for seed 1234567.
  IntegerRandom random(1234567);
  EXPECT_EQ(random.Next(), 6457827717110365317U);
  EXPECT_EQ(random.Next(), 3203168211198807973U);
}

TEST(IntegerRandom, DrawsEveryNumberOfARangeAndNoOther) {
  IntegerRandom random(1);
  std::set<int> drawn;
  for (int i = 0; i < 1000; ++i) drawn.insert(random.In(-3, 3));
  EXPECT_EQ(drawn, (std::set<int>{-3, -2, -1, 0, 1, 2, 3}));
}

TEST(Sine, AgreesWithTheRealOneToAMillionth) {
  for (int angle = -2 * kTurn; angle <= 2 * kTurn; ++angle) {
    const double real = std::sin(angle * 2 * M_PI / kTurn);
    const double ours =
        static_cast<double>(Sine(angle)) / static_cast<double>(1LL << 30);
    ASSERT_NEAR(ours, real, 1e-6) << angle;
  }
}

TEST(PolygonSpans, ASquareHasTheCellsWhoseCentresLieInside) {
  const std::vector<FinePoint> square = {
      {1 * kFine - 8, 2 * kFine - 8},
      {4 * kFine - 8, 2 * kFine - 8},
      {4 * kFine - 8, 4 * kFine - 8},
      {1 * kFine - 8, 4 * kFine - 8},
  };
  EXPECT_EQ(CellsOf(PolygonSpans(square, 10, 10)),
            (std::set<Cell>{{1, 2}, {1, 3}, {2, 2}, {2, 3}, {3, 2}, {3, 3}}));
}

TEST(PolygonSpans, PolygonsThatShareAnEdgeShareNoCellAndLeaveNone) {
  IntegerRandom random(7);
  for (int i = 0; i < 50; ++i) {
    const FinePoint top{random.In(0, 20 * kFine), -5};
    const FinePoint bottom{random.In(0, 20 * kFine), 20 * kFine + 5};
    const std::vector<FinePoint> left = {
        {-1, -5}, top, bottom, {-1, 20 * kFine + 5}};
    const std::vector<FinePoint> right = {
        top, {20 * kFine, -5}, {20 * kFine, 20 * kFine + 5}, bottom};
    std::set<Cell> cells = CellsOf(PolygonSpans(left, 20, 20));
    const std::set<Cell> others = CellsOf(PolygonSpans(right, 20, 20));
    const std::size_t total = cells.size() + others.size();
    cells.insert(others.begin(), others.end());
    EXPECT_EQ(cells.size(), total);
    EXPECT_EQ(cells.size(), 400U);
  }
}

TEST(PolygonSpans, AreClippedToTheMap) {
  const std::vector<FinePoint> around = {
      {-900, -900}, {900, -900}, {900, 900}, {-900, 900}};
  EXPECT_EQ(CellsOf(PolygonSpans(around, 6, 5)).size(), 30U);
}

TEST(Star, EveryCellLiesWithinTheRadiusOfTheCentre) {
  IntegerRandom random(11);
  const StarRanges ranges{{20, 60}, {5, 11}, {35, 100}};
  for (int i = 0; i < 50; ++i) {
    const Star star = RandomStar(random, ranges, 200);
    for (const Cell& c : CellsOf(PolygonSpans(star.Outline(), 200, 200))) {
      EXPECT_LE(std::hypot(c.x - star.center.x, c.y - star.center.y),
                star.radius + 1);
    }
  }
}

TEST(Ribbon, CrossesTheMapWithItsWidthInEveryRow) {
  ByteRaster raster = ByteRaster::Zero(100, 100);
  const Ribbon ribbon{.vertical = true,
                      .center = 50,
                      .half_width = 5,
                      .amplitude = 20,
                      .phase = 100,
                      .length_angle = kTurn};
  FillRibbon(raster, ribbon, 3);
  for (int y = 0; y < 100; ++y) {
    EXPECT_EQ((raster.row(y) == 3).count(), 11) << y;
  }
}

TEST(Ribbon, LyingIsTheTransposedStandingOne) {
  Ribbon ribbon{.vertical = true,
                .center = 40,
                .half_width = 4,
                .amplitude = 30,
                .phase = 5,
                .length_angle = 700};
  ByteRaster standing = ByteRaster::Zero(80, 80);
  FillRibbon(standing, ribbon, 2);
  ribbon.vertical = false;
  ByteRaster lying = ByteRaster::Zero(80, 80);
  FillRibbon(lying, ribbon, 2);
  EXPECT_TRUE((lying == standing.transpose()).all());
}

}  // namespace
}  // namespace terra::benchmark

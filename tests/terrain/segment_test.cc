#include "terrain/segment.h"

#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/segment_steps.h"

namespace terra {
namespace {

using ::testing::ElementsAre;

TEST(SegmentTest, TieTakesTheMinorStep) {
  EXPECT_THAT(RasterizeSegment({0, 0}, {2, 1}),
              ElementsAre(Cell{0, 0}, Cell{1, 1}, Cell{2, 1}));
}

TEST(SegmentTest, ReversedSegmentMayVisitOtherCells) {
  EXPECT_THAT(RasterizeSegment({2, 1}, {0, 0}),
              ElementsAre(Cell{2, 1}, Cell{1, 0}, Cell{0, 0}));
}

TEST(SegmentTest, EqualEndsGiveOneCell) {
  EXPECT_THAT(RasterizeSegment({3, 4}, {3, 4}), ElementsAre(Cell{3, 4}));
}

TEST(SegmentTest, EverySegmentInASquareKeepsItsShape) {
  for (int x = -7; x <= 7; ++x) {
    for (int y = -7; y <= 7; ++y) {
      const CellPath cells = RasterizeSegment({0, 0}, {x, y});
      ASSERT_EQ(cells.size(), 1u + static_cast<std::size_t>(
                                       ChebyshevDistance({0, 0}, {x, y})));
      EXPECT_EQ(cells.front(), (Cell{0, 0}));
      EXPECT_EQ(cells.back(), (Cell{x, y}));
      for (std::size_t i = 1; i < cells.size(); ++i) {
        EXPECT_EQ(ChebyshevDistance(cells[i - 1], cells[i]), 1);
      }
    }
  }
}

TEST(SegmentStepsTest, VisitTheCellsOfTheSegment) {
  constexpr int kWidth = 15;
  const auto index = [](Cell c) {
    return c.y * kWidth + c.x;
  };
  const Cell from{7, 7};
  for (int x = 0; x < kWidth; ++x) {
    for (int y = 0; y < kWidth; ++y) {
      const CellPath cells = RasterizeSegment(from, {x, y});
      SegmentSteps steps(from, {x, y}, kWidth);
      ASSERT_EQ(steps.count() + 1, std::ssize(cells));
      std::ptrdiff_t at = index(from);
      for (std::size_t i = 1; i < cells.size(); ++i) {
        const bool diagonal = steps.NextIsDiagonal();
        EXPECT_EQ(diagonal,
                  cells[i].x != cells[i - 1].x && cells[i].y != cells[i - 1].y);
        at += steps.along_longer() + (diagonal ? steps.along_shorter() : 0);
        EXPECT_EQ(at, index(cells[i])) << x << ", " << y << ", step " << i;
      }
    }
  }
}

TEST(SegmentTest, ExtremeCoordinatesDoNotOverflow) {
  SegmentCells walk({-2147483647, -2147483647}, {2147483647, 2147483646});
  walk.Next();
  EXPECT_EQ(walk.cell(), (Cell{-2147483646, -2147483646}));
}

TEST(RouteCellsTest, JointsAndRepeatedWaypointsComeOnce) {
  EXPECT_THAT(RasterizeRoute({{0, 0}, {1, 0}, {1, 0}, {2, 0}}),
              ElementsAre(Cell{0, 0}, Cell{1, 0}, Cell{2, 0}));
}

TEST(RouteCellsTest, CornersRasteriseBackToTheSamePath) {
  const CellPath path = RasterizeRoute({{0, 0}, {7, 3}, {2, 9}, {2, 2}});
  EXPECT_EQ(RasterizeRoute(CornersOf(path)), path);
}

TEST(RouteCellsTest, PathOfOneCellHasTwoEqualCorners) {
  EXPECT_THAT(CornersOf({{5, 6}}), ElementsAre(Cell{5, 6}, Cell{5, 6}));
}

}  // namespace
}  // namespace terra

#include "terrain/octile_paths.h"

#include <algorithm>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace terra {
namespace {

// Diagonal and straight steps of the shortest way between two cells.
std::pair<int, int> Steps(Cell a, Cell b) {
  const int dx = std::abs(a.x - b.x);
  const int dy = std::abs(a.y - b.y);
  return {std::min(dx, dy), std::abs(dx - dy)};
}

bool LiesBetween(Cell source, Cell cell, Cell goal) {
  const auto [to_diagonal, to_straight] = Steps(source, cell);
  const auto [on_diagonal, on_straight] = Steps(cell, goal);
  return Steps(source, goal) ==
         std::pair(to_diagonal + on_diagonal, to_straight + on_straight);
}

TEST(OctilePathsTest, ContainWhatLiesOnAnOctilePathFromASource) {
  constexpr int kSide = 24;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> any(0, kSide - 1);
  for (int trial = 0; trial < 300; ++trial) {
    const Cell goal{any(random), any(random)};
    std::vector<Cell> sources;
    for (int i = 0; i < trial % 6; ++i) {
      sources.push_back({any(random), any(random)});
    }
    const OctilePaths paths(sources, goal);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Cell cell{x, y};
        const bool expected =
            std::any_of(sources.begin(), sources.end(), [&](const Cell source) {
              return LiesBetween(source, cell, goal);
            });
        EXPECT_EQ(paths.Contain(cell), expected)
            << trial << ": " << x << "," << y;
      }
    }
  }
}

}  // namespace
}  // namespace terra

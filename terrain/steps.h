#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numbers>

#include "terrain/cell.h"

namespace terra {

/// The eight steps to neighbouring cells, clockwise on the screen from east
/// (+x). The odd ones are diagonal.
inline constexpr std::array<Cell, 8> kSteps = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Length of a step between 8-neighbours, in cells.
constexpr double StepLength(Cell from, Cell to) {
  return from.x != to.x && from.y != to.y ? std::numbers::sqrt2 : 1.0;
}

/// Length of the shortest path of 8-neighbour steps between two cells of a map,
/// in cells.
inline double OctileDistance(Cell a, Cell b) {
  const int dx = std::abs(a.x - b.x);
  const int dy = std::abs(a.y - b.y);
  return std::max(dx, dy) + (std::numbers::sqrt2 - 1) * std::min(dx, dy);
}

}  // namespace terra

#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace terra {

/// A map cell. Frame: (0, 0) top-left, +x right, +y down. Units: cells.
struct Cell {
  int x = 0;
  int y = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// Waypoints in travel order: first = start, last = goal.
using Route = std::vector<Cell>;

/// Successive 8-neighbours in travel order, as a rasterised route visits them.
using CellPath = std::vector<Cell>;

/// Returns max(|dx|, |dy|), the number of raster steps between two cells.
/// 64-bit, so that coordinates from a hostile message cannot overflow.
inline std::int64_t ChebyshevDistance(Cell a, Cell b) {
  const std::int64_t dx = std::int64_t{a.x} - b.x;
  const std::int64_t dy = std::int64_t{a.y} - b.y;
  return std::max(std::abs(dx), std::abs(dy));
}

/// Returns "(x, y)".
inline std::string ToString(Cell cell) {
  return "(" + std::to_string(cell.x) + ", " + std::to_string(cell.y) + ")";
}

}  // namespace terra

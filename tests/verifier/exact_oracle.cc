#include "tests/verifier/exact_oracle.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace terra::verifier {
namespace {

__extension__ using Int128 = __int128;

constexpr std::int64_t kUnitsPerCost = 100'000'000;
constexpr std::int64_t kEpsilonUnits = 100;

// Returns whether p + q sqrt 2 > 0.
bool IsPositive(Int128 p, Int128 q) {
  if (p >= 0 && q >= 0) return p > 0 || q > 0;
  if (p <= 0 && q <= 0) return false;
  return p > 0 ? p * p > 2 * q * q : 2 * q * q > p * p;
}

bool Inside(const TerrainMap& map, long x, long y) {
  return x >= 0 && y >= 0 && x < map.ids().cols() && y < map.ids().rows();
}

// The cells of a segment, as the design's text has them, up to the first one
// outside the map.
std::vector<std::pair<long, long>> Cells(const TerrainMap& map, Cell from,
                                         Cell to) {
  const long x1 = to.x;
  const long y1 = to.y;
  long x = from.x;
  long y = from.y;
  const long dx = std::labs(x1 - x);
  const long dy = -std::labs(y1 - y);
  const long sx = x < x1 ? 1 : -1;
  const long sy = y < y1 ? 1 : -1;
  long e = dx + dy;
  std::vector<std::pair<long, long>> cells;
  while (true) {
    cells.emplace_back(x, y);
    if (!Inside(map, x, y) || (x == x1 && y == y1)) return cells;
    const long e2 = 2 * e;
    if (e2 >= dy) {
      e += dy;
      x += sx;
    }
    if (e2 <= dx) {
      e += dx;
      y += sy;
    }
  }
}

}  // namespace

double ExactCost::value() const {
  return (static_cast<double>(straight) +
          static_cast<double>(diagonal) * std::numbers::sqrt2) /
         static_cast<double>(kUnitsPerCost);
}

bool ExactlyCheaper(const ExactCost& a, const ExactCost& b) {
  return IsPositive(Int128{b.straight} - a.straight - kEpsilonUnits,
                    Int128{b.diagonal} - a.diagonal);
}

OracleCheck OracleCheckRoute(const TerrainMap& map, const Route& route,
                             Cell start, Cell goal) {
  if (route.size() < 2) return {Code::kTooFewWaypoints, {}};
  if (route.size() > 2'048) return {Code::kWorkLimit, {}};
  if (route.front() != start) return {Code::kStartMismatch, {}};
  if (route.back() != goal) return {Code::kGoalMismatch, {}};
  ExactCost cost;
  std::pair<long, long> before{start.x, start.y};
  for (std::size_t i = 1; i < route.size(); ++i) {
    for (const auto& [x, y] : Cells(map, route[i - 1], route[i])) {
      if (!Inside(map, x, y)) return {Code::kOutOfBounds, {}};
      const double per_cell = map.legend().Find(map.ids()(y, x))->cost;
      if (std::isinf(per_cell)) return {Code::kObstacle, {}};
      const std::int64_t units = std::llround(per_cell * kUnitsPerCost);
      if (x != before.first && y != before.second) {
        cost.diagonal += units;
      } else if (x != before.first || y != before.second) {
        cost.straight += units;
      }
      before = {x, y};
    }
  }
  return {Code::kFeasible, cost};
}

std::vector<Cell> OracleCells(const TerrainMap& map, const Route& route) {
  std::vector<Cell> cells;
  for (std::size_t i = 1; i < route.size(); ++i) {
    for (const auto& [x, y] : Cells(map, route[i - 1], route[i])) {
      const Cell cell{static_cast<int>(x), static_cast<int>(y)};
      if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
  }
  return cells;
}

}  // namespace terra::verifier

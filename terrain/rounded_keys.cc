#include <cmath>
#include <numbers>

#include "terrain/require.h"
#include "terrain/search_keys.h"

namespace terra {
namespace {

using Key = RoundedKeys::Key;

struct StepKeys {
  Key straight;
  Key diagonal;
};

// A fraction p / q near sqrt 2.
struct SqrtTwo {
  Key p = 1;
  Key q = 1;
};

// The cost that a route may have at a level. At the first it is 16 times that
// of the way across the map at the lowest cost, or 64 of the dearest steps.
double Capacity(const TerrainMap& map, int level) {
  const CostTable& table = map.costs();
  const double across = std::max(map.width(), map.height()) * table.min_cost();
  const double dearest =
      table.cost[static_cast<std::size_t>(table.num_classes)];
  return std::ldexp(std::max(16 * across, 64 * dearest) * std::numbers::sqrt2,
                    6 * level);
}

double DearestPath(const TerrainMap& map) {
  const CostTable& table = map.costs();
  return static_cast<double>(map.ids().size()) *
         table.cost[static_cast<std::size_t>(table.num_classes)] *
         std::numbers::sqrt2;
}

// The convergent of sqrt 2 with the largest q up to `limit`.
SqrtTwo Convergent(double limit) {
  SqrtTwo r;
  while (static_cast<double>(r.p + r.q) <= limit) {
    r = {r.p + 2 * r.q, r.p + r.q};
  }
  return r;
}

// At least 4 and 6: canonical pruning needs a diagonal step that is dearer than
// one straight step and cheaper than two.
StepKeys Rounded(double cost, double keys_per_cost) {
  const double straight = std::max(cost * keys_per_cost, 4.0);
  return {static_cast<Key>(std::llround(straight)),
          static_cast<Key>(std::llround(straight * std::numbers::sqrt2))};
}

}  // namespace

int RoundedKeys::NumLevels(const TerrainMap& map) {
  int levels = 1;
  while (Capacity(map, levels - 1) < DearestPath(map)) ++levels;
  return levels;
}

RoundedKeys::RoundedKeys(const TerrainMap& map, int level) {
  // Below it ties of exact units are better found than sums are rounded.
  constexpr Key kLeastQ = 33'461;
  const CostTable& table = map.costs();
  TERRA_REQUIRE(table.num_classes > 0 && level >= 0);
  const double per_cost = static_cast<double>(kLimit) / Capacity(map, level);
  // A power of two: rounding then is of the step alone.
  const double rounded_per_cost = std::ldexp(1.0, std::ilogb(per_cost));
  const SqrtTwo root =
      table.scale == 0 ? SqrtTwo() : Convergent(per_cost / table.scale);
  for (int k = 1; k <= table.num_classes; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const auto units = static_cast<Key>(table.units[i]);
    const StepKeys step = root.q >= kLeastQ
                              ? StepKeys{units * root.q, units * root.p}
                              : Rounded(table.cost[i], rounded_per_cost);
    const auto code =
        map.cost_grid().holds_units() ? static_cast<std::size_t>(units) : i;
    if (straight_.size() <= code) {
      straight_.resize(code + 1);
      diagonal_.resize(code + 1);
    }
    straight_[code] = step.straight;
    diagonal_[code] = step.diagonal;
    if (k == 1) {
      min_straight_ = step.straight;
      min_diagonal_ = step.diagonal;
    }
    max_diagonal_ = step.diagonal;
    most_per_cost_ = std::max(
        {most_per_cost_, static_cast<double>(step.straight) / table.cost[i],
         static_cast<double>(step.diagonal) /
             (table.cost[i] * std::numbers::sqrt2)});
  }
}

}  // namespace terra

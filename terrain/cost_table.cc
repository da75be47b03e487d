#include "terrain/cost_table.h"

#include <cmath>
#include <set>

namespace terra {
namespace {

// Returns the smallest scale of the list that makes all costs integers, else 0.
std::int32_t FindScale(const std::set<double>& costs) {
  for (const std::int32_t scale : {1, 2, 4, 10, 20, 100, 1000}) {
    bool exact = true;
    for (const double cost : costs) {
      const double scaled = cost * scale;
      exact = exact &&
              std::abs(scaled - std::round(scaled)) <= 1e-12 * scaled &&
              scaled <= 1e9;
    }
    if (exact) {
      return scale;
    }
  }
  return 0;
}

}  // namespace

CostTable MakeCostTable(const Legend& legend) {
  std::set<double> costs;
  for (const Terrain& terrain : legend.terrains()) {
    if (std::isfinite(terrain.cost)) {
      costs.insert(terrain.cost);
    }
  }
  CostTable table;
  table.cost.fill(kImpassable);
  table.scale = FindScale(costs);
  for (const double cost : costs) {
    const auto k = static_cast<std::size_t>(++table.num_classes);
    table.cost[k] = cost;
    table.units[k] =
        static_cast<std::int32_t>(std::llround(cost * table.scale));
  }
  for (const Terrain& terrain : legend.terrains()) {
    if (std::isfinite(terrain.cost)) {
      const auto rank = std::distance(costs.begin(), costs.find(terrain.cost));
      table.class_of_id[static_cast<std::size_t>(terrain.id)] =
          static_cast<std::uint8_t>(rank + 1);
    }
  }
  return table;
}

}  // namespace terra

#include "terrain/route_cost.h"

#include <numbers>

#include "terrain/require.h"
#include "terrain/segment.h"

namespace terra {
namespace {

// Sums of the costs of the cells entered by straight and by diagonal steps.
class ExactSum {
 public:
  explicit ExactSum(const CostTable& table) : table_(table) {}
  void Add(std::uint8_t cost_class, bool diagonal) {
    (diagonal ? diagonal_ : straight_) += table_.units[cost_class];
  }
  double value() const {
    return (static_cast<double>(straight_) +
            static_cast<double>(diagonal_) * std::numbers::sqrt2) /
           table_.scale;
  }

 private:
  const CostTable& table_;
  std::int64_t straight_ = 0;
  std::int64_t diagonal_ = 0;
};

class DoubleSum {
 public:
  explicit DoubleSum(const CostTable& table) : table_(table) {}
  void Add(std::uint8_t cost_class, bool diagonal) {
    (diagonal ? diagonal_ : straight_) += table_.cost[cost_class];
  }
  double value() const { return straight_ + diagonal_ * std::numbers::sqrt2; }

 private:
  const CostTable& table_;
  double straight_ = 0;
  double diagonal_ = 0;
};

RouteFault FaultAt(const TerrainMap& map, Cell cell) {
  if (!map.Contains(cell)) {
    return RouteFault::kOutOfBounds;
  }
  return map.Passable(cell) ? RouteFault::kNone : RouteFault::kObstacle;
}

// Both ends are inside the map and passable.
RouteFault FaultOfStep(const TerrainMap& map, Cell from, Cell to) {
  const RouteFault fault = FaultAt(map, to);
  if (fault != RouteFault::kNone || map.cost_model().corner_cutting ||
      from.x == to.x || from.y == to.y) {
    return fault;
  }
  const bool free =
      map.Passable(Cell{to.x, from.y}) && map.Passable(Cell{from.x, to.y});
  return free ? RouteFault::kNone : RouteFault::kObstacle;
}

template <typename Sum>
RouteWalk Walk(const TerrainMap& map, std::span<const Cell> route,
               std::int64_t max_steps) {
  RouteWalk walk;
  const auto fail = [&walk](RouteFault fault, std::size_t segment, Cell cell) {
    walk.fault = fault;
    walk.segment = static_cast<int>(segment);
    walk.cell = cell;
    return walk;
  };
  const RouteFault first = FaultAt(map, route[0]);
  if (first != RouteFault::kNone) {
    return fail(first, 0, route[0]);
  }
  Sum sum(map.costs());
  for (std::size_t i = 1; i < route.size(); ++i) {
    SegmentCells cells(route[i - 1], route[i]);
    while (!cells.done()) {
      const Cell from = cells.cell();
      cells.Next();
      const Cell to = cells.cell();
      if (walk.steps >= max_steps) {
        return fail(RouteFault::kWorkLimit, i - 1, to);
      }
      const RouteFault fault = FaultOfStep(map, from, to);
      if (fault != RouteFault::kNone) {
        return fail(fault, i - 1, to);
      }
      sum.Add(map.classes()(to.y, to.x), from.x != to.x && from.y != to.y);
      ++walk.steps;
    }
  }
  walk.cost = sum.value();
  return walk;
}

}  // namespace

RouteWalk WalkRoute(const TerrainMap& map, std::span<const Cell> route,
                    std::int64_t max_steps) {
  TERRA_REQUIRE(!route.empty());
  return map.costs().scale != 0 ? Walk<ExactSum>(map, route, max_steps)
                                : Walk<DoubleSum>(map, route, max_steps);
}

double SegmentCost(const TerrainMap& map, Cell from, Cell to) {
  const Cell ends[] = {from, to};
  return WalkRoute(map, ends).cost;
}

}  // namespace terra

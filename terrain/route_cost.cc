#include "terrain/route_cost.h"

#include <numbers>

#include "terrain/require.h"
#include "terrain/segment.h"
#include "terrain/segment_steps.h"

namespace terra {
namespace {

// What routes are summed in: exact integers where the legend has them.
class ExactUnits {
 public:
  using Sum = std::int64_t;
  explicit ExactUnits(const CostTable& table) : table_(table) {}
  Sum Of(std::uint8_t cost_class) const { return table_.units[cost_class]; }
  double Cost(Sum straight, Sum diagonal) const {
    return (static_cast<double>(straight) +
            static_cast<double>(diagonal) * std::numbers::sqrt2) /
           table_.scale;
  }

 private:
  const CostTable& table_;
};

class Doubles {
 public:
  using Sum = double;
  explicit Doubles(const CostTable& table) : table_(table) {}
  Sum Of(std::uint8_t cost_class) const { return table_.cost[cost_class]; }
  double Cost(Sum straight, Sum diagonal) const {
    return straight + diagonal * std::numbers::sqrt2;
  }

 private:
  const CostTable& table_;
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

// One walk along a route: sums what it enters, segment by segment, and stops at
// the first fault.
template <typename Costs>
class Walker {
 public:
  Walker(const TerrainMap& map, std::int64_t max_steps)
      : map_(map), costs_(map.costs()), max_steps_(max_steps) {}

  RouteWalk Run(std::span<const Cell> route) {
    const RouteFault first = FaultAt(map_, route[0]);
    if (first != RouteFault::kNone) {
      Fail(first, 0, route[0]);
      return walk_;
    }
    for (std::size_t i = 1; i < route.size(); ++i) {
      if (!SumSegment(route[i - 1], route[i]) &&
          !StepAlong(route[i - 1], route[i], i - 1)) {
        return walk_;
      }
    }
    walk_.cost = costs_.Cost(straight_, diagonal_);
    return walk_;
  }

 private:
  using Sum = typename Costs::Sum;

  void Fail(RouteFault fault, std::size_t segment, Cell cell) {
    walk_.fault = fault;
    walk_.segment = static_cast<int>(segment);
    walk_.cell = cell;
  }

  // The common case, fast: adds a segment that has no fault. Returns false, and
  // adds nothing, when it may have one. Pre: `from` inside and passable.
  bool SumSegment(Cell from, Cell to) {
    const std::int64_t count = ChebyshevDistance(from, to);
    if (!map_.Contains(to) || count > max_steps_ - walk_.steps) {
      return false;
    }
    SegmentSteps steps(from, to, map_.width());
    const bool corner_cutting = map_.cost_model().corner_cutting;
    const std::uint8_t* cell = &map_.classes()(from.y, from.x);
    bool blocked = false;
    Sum straight{};
    Sum diagonal{};
    for (int k = 0; k < steps.count(); ++k) {
      const bool both = steps.NextIsDiagonal();
      if (!corner_cutting && both) {
        blocked |=
            cell[steps.along_longer()] == 0 || cell[steps.along_shorter()] == 0;
      }
      cell += both ? steps.along_longer() + steps.along_shorter()
                   : steps.along_longer();
      blocked |= *cell == 0;
      const Sum entered = costs_.Of(*cell);
      straight += both ? Sum{} : entered;
      diagonal += both ? entered : Sum{};
    }
    if (blocked) {
      return false;
    }
    straight_ += straight;
    diagonal_ += diagonal;
    walk_.steps += count;
    return true;
  }

  // The same cell by cell. Returns false where there is a fault, and tells it.
  bool StepAlong(Cell begin, Cell end, std::size_t segment) {
    SegmentCells cells(begin, end);
    while (!cells.done()) {
      const Cell from = cells.cell();
      cells.Next();
      const Cell to = cells.cell();
      const RouteFault fault = walk_.steps >= max_steps_
                                   ? RouteFault::kWorkLimit
                                   : FaultOfStep(map_, from, to);
      if (fault != RouteFault::kNone) {
        Fail(fault, segment, to);
        return false;
      }
      const bool diagonal = from.x != to.x && from.y != to.y;
      (diagonal ? diagonal_ : straight_) +=
          costs_.Of(map_.classes()(to.y, to.x));
      ++walk_.steps;
    }
    return true;
  }

  const TerrainMap& map_;
  Costs costs_;
  std::int64_t max_steps_;
  RouteWalk walk_;
  Sum straight_{};
  Sum diagonal_{};
};

}  // namespace

RouteWalk WalkRoute(const TerrainMap& map, std::span<const Cell> route,
                    std::int64_t max_steps) {
  TERRA_REQUIRE(!route.empty());
  return map.costs().scale != 0 ? Walker<ExactUnits>(map, max_steps).Run(route)
                                : Walker<Doubles>(map, max_steps).Run(route);
}

double SegmentCost(const TerrainMap& map, Cell from, Cell to) {
  const Cell ends[] = {from, to};
  return WalkRoute(map, ends).cost;
}

}  // namespace terra

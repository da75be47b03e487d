#include "benchmark/methods/controls.h"

#include <cmath>
#include <utility>

#include "advisor/polish.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::benchmark {
namespace {

// The middle of start and goal, moved by `sideways` of their distance.
Cell Detour(Cell start, Cell goal, double sideways) {
  const double dx = goal.x - start.x;
  const double dy = goal.y - start.y;
  return {static_cast<int>(std::lround(start.x + dx / 2 - sideways * dy)),
          static_cast<int>(std::lround(start.y + dy / 2 + sideways * dx))};
}

}  // namespace

RefineOutput StraightLine(const RefineInput& input) {
  Route line = {input.baseline.front(), input.baseline.back()};
  const double cost = WalkRoute(input.map, line).cost;
  return {std::move(line), cost};
}

RefineOutput RefineByBlindDetours(const RefineInput& input) {
  constexpr double kSideways = 0.35;
  const Cell start = input.baseline.front();
  const Cell goal = input.baseline.back();
  RefineOutput best{input.baseline, input.baseline_cost};
  for (const double sideways : {0.0, kSideways, -kSideways}) {
    if (input.stop.stop_requested()) break;
    RefineOutput polished =
        advisor::Polish(input, {start, Detour(start, goal, sideways), goal});
    if (polished.cost < best.cost) best = std::move(polished);
  }
  return best;
}

RefineOutput ShortcutWithoutCost(const RefineInput& input) {
  const CellPath cells = RasterizeRoute(input.baseline);
  Route route = {cells.front()};
  for (std::size_t at = 0; at + 1 < cells.size();) {
    std::size_t to = cells.size() - 1;
    while (to > at + 1 &&
           SegmentCost(input.map, cells[at], cells[to]) == kImpassable) {
      --to;
    }
    route.push_back(cells[to]);
    at = to;
  }
  if (route.size() == 1) route.push_back(route.front());
  const double cost = WalkRoute(input.map, route).cost;
  return {std::move(route), cost};
}

}  // namespace terra::benchmark

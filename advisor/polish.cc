#include "advisor/polish.h"

#include <algorithm>
#include <array>
#include <utility>

#include "terrain/route_cost.h"

namespace terra::advisor {
namespace {

Route Repaired(const RefineInput& input, Route route) {
  for (Cell& c : route) {
    c.x = std::clamp(c.x, 0, input.map.width() - 1);
    c.y = std::clamp(c.y, 0, input.map.height() - 1);
  }
  const Cell start = input.baseline.front();
  const Cell goal = input.baseline.back();
  if (route.empty() || route.front() != start) {
    route.insert(route.begin(), start);
  }
  if (route.size() < 2 || route.back() != goal) route.push_back(goal);
  return route;
}

double CostOfValid(const RefineInput& input, const Route& route) {
  const bool has_ends = route.size() >= 2 &&
                        route.front() == input.baseline.front() &&
                        route.back() == input.baseline.back();
  return has_ends ? WalkRoute(input.map, route).cost : kImpassable;
}

}  // namespace

RefineOutput Polish(const RefineInput& input, const Route& proposal,
                    int half_width) {
  const std::array<Route, 2> around = {Repaired(input, proposal),
                                       input.baseline};
  const Corridor corridor(input.map, around, half_width);
  RefineOutput best{input.baseline, input.baseline_cost};
  Route polished = RouteInCorridor(input.map, corridor, input.baseline.front(),
                                   input.baseline.back());
  const double polished_cost = CostOfValid(input, polished);
  if (polished_cost < best.cost) best = {std::move(polished), polished_cost};
  const double raw_cost = CostOfValid(input, proposal);
  if (raw_cost < best.cost) best = {proposal, raw_cost};
  return best;
}

}  // namespace terra::advisor

#include "advisor/route_moves.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>

#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "terrain/segment_steps.h"
#include "terrain/steps.h"

namespace terra::advisor {
namespace {

// A lower bound of every route between two cells.
double LowerBound(const TerrainMap& map, Cell from, Cell to) {
  return map.costs().min_cost() * OctileDistance(from, to);
}

// Returns the cheapest place for a waypoint among its own and the 8 at a
// distance of `step` around it.
Cell BestPlace(const TerrainMap& map, Cell before, Cell at, Cell after,
               int step) {
  Cell best = at;
  double best_cost = SegmentCost(map, before, at) + SegmentCost(map, at, after);
  for (const int dx : {-step, 0, step}) {
    for (const int dy : {-step, 0, step}) {
      const Cell c{at.x + dx, at.y + dy};
      if (c == at || !map.Contains(c)) continue;
      const double limit = best_cost - kGain;
      const double there =
          SegmentCostBelow(map, before, c, limit - LowerBound(map, c, after));
      if (there == kImpassable) continue;
      const double on = SegmentCostBelow(map, c, after, limit - there);
      if (on == kImpassable) continue;
      best_cost = there + on;
      best = c;
    }
  }
  return best;
}

}  // namespace

double SegmentCostBelow(const TerrainMap& map, Cell from, Cell to,
                        double limit) {
  if (!map.Passable(from)) return kImpassable;
  const bool cut_corners = map.cost_model().corner_cutting;
  const std::array<double, 256>& cost_of = map.costs().cost;
  const double min_cost = map.costs().min_cost();
  const std::uint8_t* cell = &map.classes()(from.y, from.x);
  SegmentSteps steps(from, to, map.width());
  // A segment has as many diagonal steps as a path can have, so the bound is
  // its cost if every cell were of the cheapest terrain. Blocked cells cost
  // more than any limit.
  double cost = LowerBound(map, from, to);
  for (int k = 0; k < steps.count() && cost < limit; ++k) {
    const bool diagonal = steps.NextIsDiagonal();
    if (diagonal && !cut_corners &&
        (cell[steps.along_longer()] == 0 || cell[steps.along_shorter()] == 0)) {
      return kImpassable;
    }
    cell += steps.along_longer() + (diagonal ? steps.along_shorter() : 0);
    const double more = cost_of[*cell] - min_cost;
    cost += diagonal ? std::numbers::sqrt2 * more : more;
  }
  return cost < limit ? cost : kImpassable;
}

Route Densify(const Route& route, int spacing) {
  const auto step = static_cast<std::size_t>(spacing);
  Route points = {route.front()};
  for (std::size_t i = 1; i < route.size(); ++i) {
    const CellPath cells = RasterizeSegment(route[i - 1], route[i]);
    for (std::size_t k = step; k + 1 < cells.size(); k += step) {
      points.push_back(cells[k]);
    }
    if (points.back() != route[i]) points.push_back(route[i]);
  }
  if (points.size() == 1) points.push_back(route.back());
  return points;
}

std::vector<double> PrefixCosts(const Route& points,
                                const SegmentCostFunction& cost) {
  std::vector<double> prefix = {0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    prefix.push_back(prefix.back() + cost(points[i - 1], points[i]));
  }
  return prefix;
}

Route ThinWaypoints(const Route& route, const SegmentCostFunction& cost) {
  constexpr int kPatience = 12;
  const std::vector<double> prefix = PrefixCosts(route, cost);
  Route thinned = {route.front()};
  std::size_t at = 0;
  while (at + 1 < route.size()) {
    std::size_t next = at + 1;
    int failures = 0;
    for (std::size_t to = at + 2; to < route.size() && failures < kPatience;
         ++to) {
      const double direct = cost(route[at], route[to]);
      if (direct <= prefix[to] - prefix[at] + kGain) {
        next = to;
        failures = 0;
      } else {
        ++failures;
      }
    }
    thinned.push_back(route[next]);
    at = next;
  }
  return thinned;
}

void PerturbWaypoints(const TerrainMap& map, Route& route,
                      const std::stop_token& stop) {
  constexpr int kSweeps = 4;
  for (const int step : {16, 8, 4, 2, 1}) {
    bool moved = true;
    for (int sweep = 0; moved && sweep < kSweeps; ++sweep) {
      moved = false;
      for (std::size_t i = 1; i + 1 < route.size(); ++i) {
        if (stop.stop_requested()) return;
        const Cell place =
            BestPlace(map, route[i - 1], route[i], route[i + 1], step);
        moved = moved || place != route[i];
        route[i] = place;
      }
    }
  }
}

}  // namespace terra::advisor

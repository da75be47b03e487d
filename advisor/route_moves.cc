#include "advisor/route_moves.h"

#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

// Returns the cheapest place for a waypoint among its own and the 8 at a
// distance of `step` around it.
Cell BestPlace(const TerrainMap& map, Cell before, Cell at, Cell after,
               int step) {
  const auto cost_via = [&](Cell c) {
    const double there = SegmentCost(map, before, c);
    return there == kImpassable ? there : there + SegmentCost(map, c, after);
  };
  Cell best = at;
  double best_cost = cost_via(at);
  for (const int dx : {-step, 0, step}) {
    for (const int dy : {-step, 0, step}) {
      const Cell c{at.x + dx, at.y + dy};
      if (c == at || !map.Contains(c)) continue;
      // Nothing is cheaper than the lowest cost along the Chebyshev distances.
      const double bound = map.costs().min_cost() *
                           static_cast<double>(ChebyshevDistance(before, c) +
                                               ChebyshevDistance(c, after));
      if (bound >= best_cost - kGain) continue;
      const double cost = cost_via(c);
      if (cost < best_cost - kGain) {
        best_cost = cost;
        best = c;
      }
    }
  }
  return best;
}

}  // namespace

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

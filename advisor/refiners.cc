#include "advisor/refiners.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "terrain/native_search.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

// A gain below this is rounding, not a cheaper route.
constexpr double kGain = 1e-9;

double RouteCost(const TerrainMap& map, const Route& route) {
  return WalkRoute(map, route).cost;
}

// Cost from the first corner to each.
std::vector<double> PrefixCosts(const TerrainMap& map, const Route& corners) {
  std::vector<double> prefix = {0};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    prefix.push_back(prefix.back() +
                     SegmentCost(map, corners[i - 1], corners[i]));
  }
  return prefix;
}

// Leaves out corners where the straight segment costs no more than the path it
// replaces. Gives up on a corner after this many longer segments in a row that
// cost more, so that the work stays linear in the number of corners.
constexpr int kPatience = 12;

Route ThinCorners(const TerrainMap& map, const Route& corners) {
  const std::vector<double> prefix = PrefixCosts(map, corners);
  Route thinned = {corners.front()};
  std::size_t at = 0;
  while (at + 1 < corners.size()) {
    std::size_t next = at + 1;
    int failures = 0;
    for (std::size_t to = at + 2; to < corners.size() && failures < kPatience;
         ++to) {
      const double direct = SegmentCost(map, corners[at], corners[to]);
      if (direct <= prefix[to] - prefix[at] + kGain) {
        next = to;
        failures = 0;
      } else {
        ++failures;
      }
    }
    thinned.push_back(corners[next]);
    at = next;
  }
  return thinned;
}

// Every `step`-th cell of a route's raster, with its waypoints.
Route Densify(const Route& route, int step) {
  Route points = {route.front()};
  for (std::size_t i = 1; i < route.size(); ++i) {
    const CellPath cells = RasterizeSegment(route[i - 1], route[i]);
    for (std::size_t k = static_cast<std::size_t>(step); k + 1 < cells.size();
         k += static_cast<std::size_t>(step)) {
      points.push_back(cells[k]);
    }
    if (points.back() != route[i]) points.push_back(route[i]);
  }
  if (points.size() == 1) points.push_back(route.back());
  return points;
}

// The cheapest route over some of the points, in their order, by straight
// segments: a shortest path in the graph of all forward segments.
Route ShortcutOver(const TerrainMap& map, const Route& points) {
  const std::size_t n = points.size();
  std::vector<double> cost(n, kImpassable);
  std::vector<std::size_t> from(n, 0);
  cost[0] = 0;
  for (std::size_t to = 1; to < n; ++to) {
    for (std::size_t at = 0; at < to; ++at) {
      // Nothing is cheaper than the lowest cost along the Chebyshev distance.
      const double bound = cost[at] + map.costs().min_cost() *
                                          static_cast<double>(ChebyshevDistance(
                                              points[at], points[to]));
      if (bound >= cost[to]) continue;
      const double total = cost[at] + SegmentCost(map, points[at], points[to]);
      if (total < cost[to]) {
        cost[to] = total;
        from[to] = at;
      }
    }
  }
  TERRA_REQUIRE(cost[n - 1] < kImpassable);
  Route route;
  for (std::size_t at = n - 1; at != 0; at = from[at]) {
    route.push_back(points[at]);
  }
  route.push_back(points[0]);
  std::reverse(route.begin(), route.end());
  return route;
}

// Moves each inner waypoint to a neighbour at falling distances while that
// lowers the cost of its two segments.
void Perturb(const TerrainMap& map, Route& route) {
  constexpr int kSweeps = 4;
  for (const int step : {16, 8, 4, 2, 1}) {
    bool moved = true;
    for (int sweep = 0; moved && sweep < kSweeps; ++sweep) {
      moved = false;
      for (std::size_t i = 1; i + 1 < route.size(); ++i) {
        const auto cost_at = [&](Cell c) {
          return SegmentCost(map, route[i - 1], c) +
                 SegmentCost(map, c, route[i + 1]);
        };
        double best = cost_at(route[i]);
        Cell best_cell = route[i];
        for (const int dx : {-step, 0, step}) {
          for (const int dy : {-step, 0, step}) {
            const Cell c{route[i].x + dx, route[i].y + dy};
            const double cost = map.Contains(c) ? cost_at(c) : kImpassable;
            if (cost < best - kGain) {
              best = cost;
              best_cell = c;
            }
          }
        }
        moved = moved || best_cell != route[i];
        route[i] = best_cell;
      }
    }
  }
}

RefineOutput Cheaper(const RefineInput& input, Route route) {
  const double cost = RouteCost(input.map, route);
  if (cost < input.baseline_cost) return {std::move(route), cost};
  return {input.baseline, input.baseline_cost};
}

}  // namespace

RefineOutput RefineBySearch(const RefineInput& input) {
  const SearchResult found =
      NativeSearch(input.map, input.baseline.front(), input.baseline.back(),
                   {.upper_bound = input.baseline_cost});
  if (!found.found()) return {input.baseline, input.baseline_cost};
  return Cheaper(input, ThinCorners(input.map, CornersOf(found.cells)));
}

RefineOutput RefineByShortcut(const RefineInput& input) {
  constexpr int kPointSpacing = 6;  // Cells between the points of a shortcut.
  constexpr int kRounds = 4;
  Route route = input.baseline;
  double cost = input.baseline_cost;
  for (int round = 0; round < kRounds; ++round) {
    Route next = ShortcutOver(input.map, Densify(route, kPointSpacing));
    Perturb(input.map, next);
    const double next_cost = RouteCost(input.map, next);
    if (!(next_cost < cost - kGain)) break;
    route = std::move(next);
    cost = next_cost;
  }
  return {std::move(route), cost};
}

}  // namespace terra::advisor

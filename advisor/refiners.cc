#include "advisor/refiners.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "advisor/route_moves.h"
#include "terrain/native_search.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

// The cheapest route over some of the points, in their order, by straight
// segments: a shortest path in the graph of all forward segments. Told to stop
// it returns the points.
Route ShortcutOver(const TerrainMap& map, const Route& points,
                   const std::stop_token& stop) {
  const std::size_t n = points.size();
  std::vector<double> cost(n, kImpassable);
  std::vector<std::size_t> from(n, 0);
  cost[0] = 0;
  for (std::size_t to = 1; to < n; ++to) {
    if (stop.stop_requested()) return points;
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

RefineOutput Cheaper(const RefineInput& input, Route route) {
  const double cost = WalkRoute(input.map, route).cost;
  if (cost < input.baseline_cost) return {std::move(route), cost};
  return {input.baseline, input.baseline_cost};
}

}  // namespace

RefineOutput RefineBySearch(const RefineInput& input) {
  const SearchResult found =
      NativeSearch(input.map, input.baseline.front(), input.baseline.back(),
                   {.upper_bound = input.baseline_cost});
  if (!found.found()) return {input.baseline, input.baseline_cost};
  const auto segment_cost = [&](Cell from, Cell to) {
    return SegmentCost(input.map, from, to);
  };
  return Cheaper(input, ThinWaypoints(CornersOf(found.cells), segment_cost));
}

RefineOutput RefineByShortcut(const RefineInput& input) {
  constexpr int kPointSpacing = 6;  // Cells between the points of a shortcut.
  constexpr int kRounds = 4;
  Route route = input.baseline;
  double cost = input.baseline_cost;
  for (int round = 0; round < kRounds; ++round) {
    Route next =
        ShortcutOver(input.map, Densify(route, kPointSpacing), input.stop);
    if (input.stop.stop_requested()) break;
    PerturbWaypoints(input.map, next, input.stop);
    const double next_cost = WalkRoute(input.map, next).cost;
    if (!(next_cost < cost - kGain)) break;
    route = std::move(next);
    cost = next_cost;
  }
  return {std::move(route), cost};
}

RefineOutput RefineByBand(const RefineInput& input, int half_width) {
  const Corridor corridor(input.map, std::array{input.baseline}, half_width);
  Route route = RouteInCorridor(input.map, corridor, input.baseline.front(),
                                input.baseline.back());
  TERRA_REQUIRE(!route.empty());  // The baseline's own cells are a path.
  return Cheaper(input, std::move(route));
}

}  // namespace terra::advisor

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
    // The way over the point before bounds what is worth looking at; as good as
    // that is good enough for a longer segment, which saves waypoints.
    cost[to] = cost[to - 1] + SegmentCost(map, points[to - 1], points[to]);
    from[to] = to - 1;
    double limit = cost[to] + kGain;
    for (std::size_t at = 0; at + 1 < to; ++at) {
      const double segment =
          SegmentCostBelow(map, points[at], points[to], limit - cost[at]);
      if (segment == kImpassable) continue;
      cost[to] = cost[at] + segment;
      from[to] = at;
      limit = cost[to] - kGain;
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

}  // namespace

RefineOutput OrBaseline(const RefineInput& input, Route route) {
  const double cost = WalkRoute(input.map, route).cost;
  if (cost < input.baseline_cost) return {std::move(route), cost};
  return {input.baseline, input.baseline_cost};
}

RefineOutput RefineBySearch(const RefineInput& input) {
  const SearchResult found =
      NativeSearch(input.map, input.baseline.front(), input.baseline.back(),
                   {.upper_bound = input.baseline_cost});
  if (!found.found()) return {input.baseline, input.baseline_cost};
  const auto segment_cost = [&](Cell from, Cell to) {
    return SegmentCost(input.map, from, to);
  };
  return OrBaseline(input, ThinWaypoints(CornersOf(found.cells), segment_cost));
}

RefineOutput RefineByShortcut(const RefineInput& input) {
  // Cells between the points of a shortcut, and between waypoints that move.
  constexpr int kPointSpacing = 4;
  constexpr int kMoveSpacing = 24;
  constexpr int kRounds = 8;
  Route route = input.baseline;
  double cost = input.baseline_cost;
  for (int round = 0; round < kRounds; ++round) {
    Route next = Densify(
        ShortcutOver(input.map, Densify(route, kPointSpacing), input.stop),
        kMoveSpacing);
    if (input.stop.stop_requested()) break;
    PerturbWaypoints(input.map, next, input.stop);
    const double next_cost = WalkRoute(input.map, next).cost;
    if (!(next_cost < cost - kGain)) break;
    route = std::move(next);
    cost = next_cost;
  }
  return OrBaseline(input, ThinWaypoints(route, [&](Cell from, Cell to) {
                      return SegmentCost(input.map, from, to);
                    }));
}

}  // namespace terra::advisor

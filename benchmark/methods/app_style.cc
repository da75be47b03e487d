// APP-style refinement: what the abstract of Li, Cheng 2023 says (reduction of
// vertices from both ends because path and environment are not symmetric, then
// perturbation), with the terrain cost as the test of every segment.
#include <algorithm>
#include <utility>
#include <vector>

#include "advisor/route_moves.h"
#include "benchmark/methods/comparison_refiners.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::benchmark {
namespace {

using advisor::kGain;
using advisor::PerturbWaypoints;
using advisor::SegmentCostBelow;
using advisor::ThinWaypoints;

// Cells between the ends that a new segment is tried with.
constexpr std::size_t kSpacing = 4;
constexpr int kMaxRounds = 8;

// Works on the cells of a route: segments to replace parts of it may begin and
// end anywhere, and the next cell is always a way on.
class Reduction {
 public:
  Reduction(const TerrainMap& map, const Route& route)
      : map_(map),
        cells_(RasterizeRoute(route)),
        prefix_(advisor::PrefixCosts(cells_, [&map](Cell from, Cell to) {
          return SegmentCost(map, from, to);
        })) {}

  // From the start: to the farthest cell that a straight segment reaches
  // cheaper than the route does, else some cells along the route.
  Route Forward(const std::stop_token& stop) const {
    Route kept = {cells_.front()};
    const std::size_t end = cells_.size() - 1;
    for (std::size_t at = 0; at < end;) {
      std::size_t to = end;
      while (to > at + kSpacing && !stop.stop_requested() && !Cheaper(at, to)) {
        to -= kSpacing;
      }
      if (!Cheaper(at, to)) {
        for (; at + 1 < to; ++at) kept.push_back(cells_[at + 1]);
      }
      kept.push_back(cells_[to]);
      at = to;
    }
    return kept;
  }

  // From the goal. Segments are costed in travel direction all the same.
  Route Backward(const std::stop_token& stop) const {
    Route kept = {cells_.back()};
    for (std::size_t at = cells_.size() - 1; at > 0;) {
      std::size_t to = 0;
      while (to + kSpacing < at && !stop.stop_requested() && !Cheaper(to, at)) {
        to += kSpacing;
      }
      if (!Cheaper(to, at)) {
        for (; at > to + 1; --at) kept.push_back(cells_[at - 1]);
      }
      kept.push_back(cells_[to]);
      at = to;
    }
    std::reverse(kept.begin(), kept.end());
    return kept;
  }

 private:
  bool Cheaper(std::size_t from, std::size_t to) const {
    return SegmentCostBelow(map_, cells_[from], cells_[to],
                            prefix_[to] - prefix_[from] - kGain) < kImpassable;
  }

  const TerrainMap& map_;
  CellPath cells_;
  std::vector<double> prefix_;
};

// Both orders of the two reductions; the cheaper result, without waypoints that
// change the heading for nothing.
Route ReduceFromBothEnds(const RefineInput& input, const Route& route) {
  const Reduction whole(input.map, route);
  Route first =
      Reduction(input.map, whole.Forward(input.stop)).Backward(input.stop);
  Route second =
      Reduction(input.map, whole.Backward(input.stop)).Forward(input.stop);
  const bool first_is_cheaper =
      WalkRoute(input.map, first).cost <= WalkRoute(input.map, second).cost;
  return ThinWaypoints(first_is_cheaper ? first : second,
                       [&](Cell from, Cell to) {
                         return SegmentCost(input.map, from, to);
                       });
}

}  // namespace

RefineOutput RefineByAppStyle(const RefineInput& input) {
  RefineOutput best{input.baseline, input.baseline_cost};
  if (best.route.front() == best.route.back()) return best;
  for (int round = 0; round < kMaxRounds; ++round) {
    Route next = ReduceFromBothEnds(input, best.route);
    PerturbWaypoints(input.map, next, input.stop);
    const double cost = WalkRoute(input.map, next).cost;
    if (!(cost < best.cost - kGain)) break;
    best = {std::move(next), cost};
  }
  return best;
}

}  // namespace terra::benchmark

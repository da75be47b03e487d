#include "benchmark/speed/arc_graph.h"

#include <algorithm>
#include <cstdlib>

namespace terra::benchmark {

double OctileBound(const ArcGraph& graph, int from, int to) {
  const int dx = std::abs(from % graph.width - to % graph.width);
  const int dy = std::abs(from / graph.width - to / graph.width);
  constexpr double kTurn = 0.41421356237309503;  // Below sqrt 2 - 1.
  return graph.min_cost * (std::max(dx, dy) + kTurn * std::min(dx, dy));
}

}  // namespace terra::benchmark

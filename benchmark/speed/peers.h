#pragma once

#include <memory>

#include "benchmark/speed/arc_graph.h"

namespace terra::benchmark {

/// Another implementation of the same search at the same costs. Built once for
/// a map (not timed); a query initialises all it needs (timed).
class Peer {
 public:
  virtual ~Peer() = default;
  /// Returns the cost of a cheapest route, infinite where there is none.
  virtual double Search(int start, int goal) = 0;
};

/// boost::astar_search on a compressed_sparse_row_graph.
std::unique_ptr<Peer> MakeBoostPeer(const ArcGraph& graph);
/// lemon::Dijkstra on a StaticDigraph, arcs reduced by the octile bound when
/// they are looked at, which makes it A*.
std::unique_ptr<Peer> MakeLemonPeer(const ArcGraph& graph);

}  // namespace terra::benchmark

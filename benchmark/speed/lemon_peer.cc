#include <limits>
#include <utility>
#include <vector>

#include <lemon/dijkstra.h>
#include <lemon/static_graph.h>

#include "benchmark/speed/peers.h"

namespace terra::benchmark {
namespace {

using Graph = lemon::StaticDigraph;

// Weights reduced by a potential: never negative, as the bound is consistent.
class ReducedWeights {
 public:
  using Key = Graph::Arc;
  using Value = double;

  ReducedWeights(const ArcGraph& arcs, const Graph& graph, int goal)
      : arcs_(arcs), graph_(graph), goal_(goal) {}
  double operator[](const Graph::Arc& arc) const {
    return arcs_.weight[static_cast<std::size_t>(graph_.index(arc))] +
           OctileBound(arcs_, graph_.index(graph_.target(arc)), goal_) -
           OctileBound(arcs_, graph_.index(graph_.source(arc)), goal_);
  }

 private:
  const ArcGraph& arcs_;
  const Graph& graph_;
  int goal_;
};

class LemonPeer : public Peer {
 public:
  explicit LemonPeer(const ArcGraph& arcs) : arcs_(arcs) {
    std::vector<std::pair<int, int>> pairs;
    pairs.reserve(arcs.head.size());
    for (int node = 0; node < arcs.num_nodes; ++node) {
      const auto n = static_cast<std::size_t>(node);
      for (int i = arcs.first[n]; i < arcs.first[n + 1]; ++i) {
        pairs.emplace_back(node, arcs.head[static_cast<std::size_t>(i)]);
      }
    }
    graph_.build(arcs.num_nodes, pairs.begin(), pairs.end());
  }

  double Search(int start, int goal) override {
    const ReducedWeights weights(arcs_, graph_, goal);
    lemon::Dijkstra<Graph, ReducedWeights> search(graph_, weights);
    if (!search.run(graph_.node(start), graph_.node(goal))) {
      return std::numeric_limits<double>::infinity();
    }
    return search.dist(graph_.node(goal)) + OctileBound(arcs_, start, goal);
  }

 private:
  const ArcGraph& arcs_;
  Graph graph_;
};

}  // namespace

std::unique_ptr<Peer> MakeLemonPeer(const ArcGraph& graph) {
  return std::make_unique<LemonPeer>(graph);
}

}  // namespace terra::benchmark

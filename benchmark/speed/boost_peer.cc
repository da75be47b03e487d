#include <limits>
#include <utility>
#include <vector>

#include <boost/graph/astar_search.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include "benchmark/speed/peers.h"

namespace terra::benchmark {
namespace {

struct Weight {
  double weight;
};
using Graph = boost::compressed_sparse_row_graph<boost::directedS,
                                                 boost::no_property, Weight>;

struct GoalReached {};

struct StopAtGoal : boost::default_astar_visitor {
  explicit StopAtGoal(std::size_t wanted) : goal(wanted) {}
  template <typename AnyGraph>
  void examine_vertex(std::size_t vertex, const AnyGraph&) {
    if (vertex == goal) throw GoalReached();
  }
  std::size_t goal;
};

class Bound : public boost::astar_heuristic<Graph, double> {
 public:
  Bound(const ArcGraph& arcs, int goal) : arcs_(&arcs), goal_(goal) {}
  double operator()(std::size_t node) {
    return OctileBound(*arcs_, static_cast<int>(node), goal_);
  }

 private:
  const ArcGraph* arcs_;
  int goal_;
};

class BoostPeer : public Peer {
 public:
  explicit BoostPeer(const ArcGraph& arcs) : arcs_(arcs) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    std::vector<Weight> weights;
    pairs.reserve(arcs.head.size());
    weights.reserve(arcs.head.size());
    for (std::size_t n = 0; n < static_cast<std::size_t>(arcs.num_nodes); ++n) {
      for (int i = arcs.first[n]; i < arcs.first[n + 1]; ++i) {
        const auto k = static_cast<std::size_t>(i);
        pairs.emplace_back(n, static_cast<std::size_t>(arcs.head[k]));
        weights.push_back({arcs.weight[k]});
      }
    }
    graph_ = Graph(boost::edges_are_sorted, pairs.begin(), pairs.end(),
                   weights.begin(), static_cast<std::size_t>(arcs.num_nodes));
  }

  double Search(int start, int goal) override {
    const auto size = static_cast<std::size_t>(arcs_.num_nodes);
    std::vector<double> distance(size);
    std::vector<std::size_t> predecessor(size);
    try {
      boost::astar_search(
          graph_, static_cast<std::size_t>(start), Bound(arcs_, goal),
          boost::weight_map(boost::get(&Weight::weight, graph_))
              .distance_map(distance.data())
              .predecessor_map(predecessor.data())
              .visitor(StopAtGoal(static_cast<std::size_t>(goal))));
    } catch (const GoalReached&) {
      return distance[static_cast<std::size_t>(goal)];
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  const ArcGraph& arcs_;
  Graph graph_;
};

}  // namespace

std::unique_ptr<Peer> MakeBoostPeer(const ArcGraph& graph) {
  return std::make_unique<BoostPeer>(graph);
}

}  // namespace terra::benchmark

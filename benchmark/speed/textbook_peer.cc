#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "benchmark/speed/peers.h"

namespace terra::benchmark {
namespace {

class TextbookPeer : public Peer {
 public:
  explicit TextbookPeer(const ArcGraph& graph) : graph_(graph) {}

  double Search(int start, int goal) override {
    const auto size = static_cast<std::size_t>(graph_.num_nodes);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> distance(size, kInfinity);
    std::vector<int> predecessor(size, -1);
    std::vector<bool> closed(size, false);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    distance[static_cast<std::size_t>(start)] = 0;
    open.emplace(OctileBound(graph_, start, goal), start);
    while (!open.empty()) {
      const int node = open.top().second;
      const auto n = static_cast<std::size_t>(node);
      open.pop();
      if (node == goal) return distance[n];
      if (closed[n]) continue;
      closed[n] = true;
      for (int i = graph_.first[n]; i < graph_.first[n + 1]; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const auto next = static_cast<std::size_t>(graph_.head[k]);
        const double through = distance[n] + graph_.weight[k];
        if (through < distance[next]) {
          distance[next] = through;
          predecessor[next] = node;
          open.emplace(through + OctileBound(graph_, graph_.head[k], goal),
                       graph_.head[k]);
        }
      }
    }
    return kInfinity;
  }

 private:
  const ArcGraph& graph_;
};

}  // namespace

double OctileBound(const ArcGraph& graph, int from, int to) {
  const int dx = std::abs(from % graph.width - to % graph.width);
  const int dy = std::abs(from / graph.width - to / graph.width);
  constexpr double kTurn = 0.41421356237309503;  // Below sqrt 2 - 1.
  return graph.min_cost * (std::max(dx, dy) + kTurn * std::min(dx, dy));
}

std::unique_ptr<Peer> MakeTextbookPeer(const ArcGraph& graph) {
  return std::make_unique<TextbookPeer>(graph);
}

}  // namespace terra::benchmark

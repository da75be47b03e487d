#include "planner/waypoint_graph.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "planner/step_costs.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"

namespace terra::planner {
namespace {

// Dijkstra from the goal backwards, so that afterwards every vertex knows what
// is still to come and the smallest sequence is read off from the start. Labels
// are (cost, raster steps) in lexicographic order.
template <typename Arithmetic>
class GraphSearch {
 public:
  GraphSearch(const TerrainMap& map, const WaypointGraph& graph, Cell start,
              Cell goal, int reach)
      : map_(map),
        costs_(map),
        graph_(graph),
        reach_(reach),
        start_(graph.nodes().size()),
        goal_(start_ + 1),
        labels_(start_ + 2) {
    for (const WaypointGraph::Node& node : graph.nodes()) {
      cells_.push_back(node.cell);
    }
    cells_.push_back(start);
    cells_.push_back(goal);
  }

  LatticePlan Run() {
    Reach(goal_, {Cost{}, 0});
    while (!open_.empty()) {
      const Entry entry = open_.top();
      open_.pop();
      if (labels_[entry.vertex] < entry.label) continue;  // Found cheaper.
      ++plan_.expanded;
      if (entry.vertex == start_) {
        plan_.status = SearchStatus::kFound;
        plan_.waypoints = RouteFromStart();
        plan_.cost = WalkRoute(map_, plan_.waypoints).cost;
        break;
      }
      Expand(entry);
    }
    return std::move(plan_);
  }

 private:
  using Cost = typename Arithmetic::Cost;

  struct Label {
    Cost cost = Arithmetic::kUnreached;  // From here to the goal.
    std::int64_t steps = 0;

    friend bool operator<(const Label& a, const Label& b) {
      return std::tie(a.cost, a.steps) < std::tie(b.cost, b.steps);
    }
    friend bool operator==(const Label&, const Label&) = default;
  };
  struct Entry {
    Label label;
    std::size_t vertex;

    friend bool operator>(const Entry& a, const Entry& b) {
      return b.label < a.label;
    }
  };

  void Reach(std::size_t vertex, const Label& label) {
    if (!(label < labels_[vertex])) return;
    labels_[vertex] = label;
    open_.push({label, vertex});
  }

  // The label of the way over a segment; unreached where it is not feasible.
  Label Over(std::size_t from, std::size_t to) const {
    const Cell a = cells_[from];
    const Cell b = cells_[to];
    if (!map_.Contains(a) || !map_.Contains(b) || !map_.Passable(a)) return {};
    const Cost cost = costs_.Segment(a, b);
    if (!(cost < Arithmetic::kUnreached)) return {};
    return {cost + labels_[to].cost,
            ChebyshevDistance(a, b) + labels_[to].steps};
  }

  void FollowBack(std::size_t from, std::size_t to) {
    ++plan_.edges_costed;
    Reach(from, Over(from, to));
  }

  bool WithinReach(std::size_t a, std::size_t b) const {
    return ChebyshevDistance(cells_[a], cells_[b]) <= reach_;
  }

  void Expand(const Entry& to) {
    if (to.vertex == goal_) {
      for (std::size_t node = 0; node < start_; ++node) {
        if (WithinReach(node, goal_)) FollowBack(node, goal_);
      }
    } else {
      for (const std::size_t node : graph_.Neighbours(to.vertex)) {
        FollowBack(node, to.vertex);
      }
    }
    if (WithinReach(start_, to.vertex)) FollowBack(start_, to.vertex);
  }

  // Calls visit(vertex) for each vertex that a best way leads to from here.
  template <typename Visit>
  void ForEachNext(std::size_t from, const Visit& visit) const {
    const auto try_next = [&](std::size_t to) {
      if (labels_[to].cost < Arithmetic::kUnreached &&
          Over(from, to) == labels_[from]) {
        visit(to);
      }
    };
    if (from == start_) {
      for (std::size_t node = 0; node < start_; ++node) {
        if (WithinReach(start_, node)) try_next(node);
      }
    } else {
      for (const std::size_t node : graph_.Neighbours(from)) try_next(node);
    }
    if (WithinReach(from, goal_)) try_next(goal_);
  }

  // Adds to vertices of one cell those of the same cell that best ways lead to.
  void AddVerticesOfCell(std::vector<std::size_t>& vertices) const {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      ForEachNext(vertices[i], [&](std::size_t next) {
        if (cells_[next] == cells_[vertices[i]]) AddOnce(vertices, next);
      });
    }
  }

  static void AddOnce(std::vector<std::size_t>& vertices, std::size_t vertex) {
    if (std::find(vertices.begin(), vertices.end(), vertex) == vertices.end()) {
      vertices.push_back(vertex);
    }
  }

  // From the vertices at a cell, those at the first cell in row order that a
  // best way leads to.
  std::vector<std::size_t> FirstNext(
      const std::vector<std::size_t>& from) const {
    std::vector<std::size_t> first;
    const auto place = [this](std::size_t vertex) {
      return std::pair(cells_[vertex].y, cells_[vertex].x);
    };
    for (const std::size_t vertex : from) {
      ForEachNext(vertex, [&](std::size_t next) {
        if (cells_[next] == cells_[vertex]) return;
        if (!first.empty() && place(next) < place(first.front())) first.clear();
        if (first.empty() || place(next) == place(first.front())) {
          AddOnce(first, next);
        }
      });
    }
    TERRA_REQUIRE(!first.empty());
    return first;
  }

  // An end that lies on a node is one waypoint with it.
  Route RouteFromStart() const {
    std::vector<std::size_t> at = {start_};
    Route route;
    for (;;) {
      route.push_back(cells_[at.front()]);
      if (route.back() == cells_[goal_]) return route;
      AddVerticesOfCell(at);
      at = FirstNext(at);
    }
  }

  const TerrainMap& map_;
  StepCosts<Arithmetic> costs_;
  const WaypointGraph& graph_;
  int reach_;
  // Vertices: the graph's nodes, then start and goal.
  std::size_t start_;
  std::size_t goal_;
  std::vector<Cell> cells_;
  std::vector<Label> labels_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
  LatticePlan plan_;
};

}  // namespace

WaypointGraph::WaypointGraph(std::vector<Node> nodes,
                             const std::vector<Edge>& edges)
    : nodes_(std::move(nodes)), neighbours_(nodes_.size()) {
  TERRA_REQUIRE(nodes_.size() <= kMaxNodes && edges.size() <= kMaxEdges);
  for (const auto& [a, b] : edges) {
    TERRA_REQUIRE(a < nodes_.size() && b < nodes_.size() && a != b);
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }
}

LatticePlan PlanOnGraph(const TerrainMap& map, const WaypointGraph& graph,
                        Cell start, Cell goal, int reach) {
  TERRA_REQUIRE(reach >= 0 && reach <= kMaxReach);
  LatticePlan plan;
  plan.status = CheckSearchEnds(map, start, goal);
  if (!plan.found()) return plan;
  if (start == goal) {
    plan.waypoints = {start, goal};
    plan.cost = 0;
    return plan;
  }
  if (map.costs().scale != 0) {
    return GraphSearch<ExactArithmetic>(map, graph, start, goal, reach).Run();
  }
  return GraphSearch<DoubleArithmetic>(map, graph, start, goal, reach).Run();
}

}  // namespace terra::planner

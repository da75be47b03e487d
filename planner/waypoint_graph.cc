#include "planner/waypoint_graph.h"

#include <algorithm>
#include <functional>
#include <queue>

#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"

namespace terra::planner {
namespace {

class GraphSearch {
 public:
  GraphSearch(const TerrainMap& map, const WaypointGraph& graph, int reach)
      : map_(map),
        graph_(graph),
        reach_(reach),
        start_(graph.nodes().size()),
        goal_(start_ + 1),
        cells_(start_ + 2),
        labels_(start_ + 2) {
    for (std::size_t i = 0; i < start_; ++i) cells_[i] = graph.nodes()[i].cell;
  }

  LatticePlan Run(Cell start, Cell goal) {
    cells_[start_] = start;
    cells_[goal_] = goal;
    Reach(start_, 0, start_);
    while (!open_.empty()) {
      const Entry entry = open_.top();
      open_.pop();
      if (entry.cost > labels_[entry.vertex].cost) continue;  // Found cheaper.
      ++plan_.expanded;
      if (entry.vertex == goal_) {
        plan_.status = SearchStatus::kFound;
        plan_.waypoints = RouteToGoal();
        plan_.cost = WalkRoute(map_, plan_.waypoints).cost;
        break;
      }
      Expand(entry);
    }
    return std::move(plan_);
  }

 private:
  struct Label {
    double cost = kImpassable;  // From the start.
    std::size_t before = 0;     // The vertex that the way comes from.
  };
  struct Entry {
    double cost;
    std::size_t vertex;

    friend auto operator<=>(const Entry&, const Entry&) = default;
  };

  void Reach(std::size_t vertex, double cost, std::size_t before) {
    if (cost >= labels_[vertex].cost) return;
    labels_[vertex] = {cost, before};
    open_.push({cost, vertex});
  }

  void FollowSegment(const Entry& from, std::size_t to) {
    ++plan_.edges_costed;
    const double cost = SegmentCost(map_, cells_[from.vertex], cells_[to]);
    if (cost < kImpassable) Reach(to, from.cost + cost, from.vertex);
  }

  bool WithinReach(std::size_t a, std::size_t b) const {
    return ChebyshevDistance(cells_[a], cells_[b]) <= reach_;
  }

  void Expand(const Entry& from) {
    if (from.vertex == start_) {
      for (std::size_t node = 0; node < start_; ++node) {
        if (WithinReach(start_, node)) FollowSegment(from, node);
      }
    } else {
      for (const std::size_t node : graph_.Neighbours(from.vertex)) {
        FollowSegment(from, node);
      }
    }
    if (WithinReach(from.vertex, goal_)) FollowSegment(from, goal_);
  }

  // An end that lies on a node is one waypoint with it.
  Route RouteToGoal() const {
    Route route = {cells_[goal_]};
    for (std::size_t at = goal_; at != start_;) {
      at = labels_[at].before;
      if (cells_[at] != route.back()) route.push_back(cells_[at]);
    }
    std::reverse(route.begin(), route.end());
    return route;
  }

  const TerrainMap& map_;
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
  return GraphSearch(map, graph, reach).Run(start, goal);
}

}  // namespace terra::planner

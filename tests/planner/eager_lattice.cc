#include "tests/planner/eager_lattice.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

namespace terra::testing {
namespace {

// Cells in the order of the tie rule: row by row.
using RowMajor = std::tuple<int, int>;
RowMajor Key(Cell c) {
  return {c.y, c.x};
}

// The map as thousandths per cell, 0 = blocked, found the long way round.
class Ground {
 public:
  explicit Ground(const TerrainMap& map)
      : width_(map.width()),
        height_(map.height()),
        model_(map.cost_model()),
        cost_(static_cast<std::size_t>(width_) *
              static_cast<std::size_t>(height_)) {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const double cost = map.legend().Find(map.ids()(y, x))->cost;
        const bool open = std::isfinite(cost) && !NearObstacle(map, {x, y});
        At({x, y}) = open ? std::llround(cost * 1000) : 0;
      }
    }
  }

  bool Contains(Cell c) const {
    return 0 <= c.x && c.x < width_ && 0 <= c.y && c.y < height_;
  }
  std::int64_t Cost(Cell c) const {
    return cost_[static_cast<std::size_t>(c.y * width_ + c.x)];
  }

  // The cost of a straight segment; nothing when it is not feasible.
  std::optional<ExactCost> Segment(Cell from, Cell to) const {
    const int dx = std::abs(to.x - from.x);
    const int dy = -std::abs(to.y - from.y);
    const int sx = from.x < to.x ? 1 : -1;
    const int sy = from.y < to.y ? 1 : -1;
    int e = dx + dy;
    ExactCost sum;
    Cell at = from;
    while (at != to) {
      const int e2 = 2 * e;
      Cell next = at;
      if (e2 >= dy) {
        e += dy;
        next.x += sx;
      }
      if (e2 <= dx) {
        e += dx;
        next.y += sy;
      }
      if (Cost(next) == 0) return std::nullopt;
      if (next.x != at.x && next.y != at.y) {
        const bool squeezes =
            Cost({at.x, next.y}) == 0 || Cost({next.x, at.y}) == 0;
        if (squeezes && !model_.corner_cutting) return std::nullopt;
        sum.diagonal += Cost(next);
      } else {
        sum.straight += Cost(next);
      }
      at = next;
    }
    return sum;
  }

 private:
  std::int64_t& At(Cell c) {
    return cost_[static_cast<std::size_t>(c.y * width_ + c.x)];
  }

  bool NearObstacle(const TerrainMap& map, Cell c) const {
    const int r = model_.clearance_cells;
    for (int y = c.y - r; y <= c.y + r; ++y) {
      for (int x = c.x - r; x <= c.x + r; ++x) {
        const int d2 = (x - c.x) * (x - c.x) + (y - c.y) * (y - c.y);
        if (d2 <= r * r && Contains({x, y}) &&
            !std::isfinite(map.legend().Find(map.ids()(y, x))->cost)) {
          return true;
        }
      }
    }
    return false;
  }

  int width_;
  int height_;
  CostModel model_;
  std::vector<std::int64_t> cost_;
};

// Whether the joint rule lets an end be joined to a node.
bool Joins(Cell end, Cell node, const planner::LatticeOptions& options) {
  const int r = options.stride;
  const int dx = std::abs(end.x - node.x);
  const int dy = std::abs(end.y - node.y);
  switch (options.joints) {
    case planner::JointRule::kTwoStrides:
      return std::max(dx, dy) <= 2 * r;
    case planner::JointRule::kVisible:
      return true;
    case planner::JointRule::kCell:
      // Within one stride, a node on the end's own line included, is a corner
      // of a lattice cell that holds the end, its border being part of it.
      return dx <= r && dy <= r;
  }
  return false;
}

struct Edge {
  Cell to;
  ExactCost cost;
  std::int64_t steps = 0;
};
using Graph = std::map<RowMajor, std::vector<Edge>>;

class GraphBuilder {
 public:
  explicit GraphBuilder(const Ground& ground) : ground_(ground) {}

  void Connect(Cell from, Cell to) {
    if (from == to || ground_.Cost(from) == 0 || ground_.Cost(to) == 0) return;
    if (const auto cost = ground_.Segment(from, to)) {
      graph_[Key(from)].push_back({to, *cost, ChebyshevDistance(from, to)});
    }
  }
  Graph Take() { return std::move(graph_); }

 private:
  const Ground& ground_;
  Graph graph_;
};

Graph ListEdges(const Ground& ground, Cell start, Cell goal,
                const planner::LatticeOptions& options) {
  const int r = options.stride;
  GraphBuilder graph(ground);
  for (int y = 0; ground.Contains({0, y}); y += r) {
    for (int x = 0; ground.Contains({x, 0}); x += r) {
      const Cell node{x, y};
      for (const int dy : {-r, 0, r}) {
        for (const int dx : {-r, 0, r}) {
          const Cell to{x + dx, y + dy};
          if (ground.Contains(to)) graph.Connect(node, to);
        }
      }
      if (Joins(start, node, options)) graph.Connect(start, node);
      if (Joins(goal, node, options)) graph.Connect(node, goal);
    }
  }
  if (ChebyshevDistance(start, goal) <= 2 * r) graph.Connect(start, goal);
  return graph.Take();
}

struct Label {
  ExactCost cost;
  std::int64_t steps = 0;
  std::vector<RowMajor> nodes;  // Also the way back to the start.

  friend bool operator<(const Label& a, const Label& b) {
    return std::tie(a.cost, a.steps, a.nodes) <
           std::tie(b.cost, b.steps, b.nodes);
  }
};

}  // namespace

double ExactCost::value() const {
  return (static_cast<double>(straight) +
          static_cast<double>(diagonal) * std::sqrt(2.0)) /
         1000;
}

// The sign of u + v sqrt 2: by squares where u and v differ in sign.
std::strong_ordering operator<=>(ExactCost a, ExactCost b) {
  const std::int64_t u = a.straight - b.straight;
  const std::int64_t v = a.diagonal - b.diagonal;
  if (u >= 0 && v >= 0) return u + v <=> 0;
  if (u <= 0 && v <= 0) return u + v <=> 0;
  const std::strong_ordering squares = u * u <=> 2 * v * v;
  return u > 0 ? squares : 0 <=> squares;
}

EagerPlan PlanEagerly(const TerrainMap& map, Cell start, Cell goal,
                      const planner::LatticeOptions& options) {
  const Ground ground(map);
  Graph graph = ListEdges(ground, start, goal, options);
  std::map<RowMajor, Label> best;
  std::set<Label> open;
  best[Key(start)] = {{}, 0, {Key(start)}};
  open.insert(best[Key(start)]);
  while (!open.empty()) {
    const Label label = *open.begin();
    open.erase(open.begin());
    if (label.nodes.back() == Key(goal)) {
      EagerPlan plan{true, {}, label.cost};
      for (const auto& [y, x] : label.nodes) plan.waypoints.push_back({x, y});
      return plan;
    }
    for (const Edge& edge : graph[label.nodes.back()]) {
      Label next{label.cost + edge.cost, label.steps + edge.steps, label.nodes};
      next.nodes.push_back(Key(edge.to));
      const auto known = best.find(Key(edge.to));
      if (known != best.end()) {
        if (!(next < known->second)) continue;
        open.erase(known->second);
      }
      best[Key(edge.to)] = next;
      open.insert(std::move(next));
    }
  }
  return {};
}

}  // namespace terra::testing

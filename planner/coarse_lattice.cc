#include "planner/coarse_lattice.h"

#include <bit>
#include <limits>
#include <queue>
#include <tuple>
#include <vector>

#include "planner/step_costs.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"
#include "terrain/steps.h"

namespace terra::planner {
namespace {

// A node's neighbours lie kSteps away, in strides.
constexpr int kNumDirections = kSteps.size();
// A node's way on is one of the 8 directions or the joint to the goal.
constexpr unsigned kToGoal = 1U << kNumDirections;

// Where nodes lie: (i stride, j stride), 0 <= i < cols, 0 <= j < rows.
struct Lattice {
  Lattice(const TerrainMap& map, int stride_cells)
      : stride(stride_cells),
        cols((map.width() - 1) / stride + 1),
        rows((map.height() - 1) / stride + 1) {}

  bool Contains(Cell node) const {
    return node.x >= 0 && node.y >= 0 && node.x < cols && node.y < rows;
  }
  std::size_t Index(Cell node) const {
    return static_cast<std::size_t>(node.y) * static_cast<std::size_t>(cols) +
           static_cast<std::size_t>(node.x);
  }
  Cell CellOf(Cell node) const { return {node.x * stride, node.y * stride}; }

  int stride;
  int cols;
  int rows;
};

// A rectangle of nodes, ends included.
struct NodeBox {
  Cell low;
  Cell high;

  bool Contains(Cell node) const {
    return node.x >= low.x && node.y >= low.y && node.x <= high.x &&
           node.y <= high.y;
  }
};

int FloorDivide(int value, int by) {
  return value >= 0 ? value / by : -((-value + by - 1) / by);
}
int CeilDivide(int value, int by) {
  return -FloorDivide(-value, by);
}

// The nodes that a start or goal may be joined to. An end that lies on a node
// reaches the node's 8 neighbours under every rule.
NodeBox JointBox(const Lattice& lattice, Cell end, JointRule rule) {
  const int r = lattice.stride;
  NodeBox box{{0, 0}, {lattice.cols - 1, lattice.rows - 1}};
  if (rule == JointRule::kTwoStrides) {
    box = {{CeilDivide(end.x - 2 * r, r), CeilDivide(end.y - 2 * r, r)},
           {FloorDivide(end.x + 2 * r, r), FloorDivide(end.y + 2 * r, r)}};
  } else if (rule == JointRule::kCell) {
    // Corners of every closed lattice cell that holds the end.
    box = {{CeilDivide(end.x, r) - 1, CeilDivide(end.y, r) - 1},
           {FloorDivide(end.x, r) + 1, FloorDivide(end.y, r) + 1}};
  }
  box.low = {std::max(box.low.x, 0), std::max(box.low.y, 0)};
  box.high = {std::min(box.high.x, lattice.cols - 1),
              std::min(box.high.y, lattice.rows - 1)};
  return box;
}

// A* from the goal backwards, so that afterwards every vertex knows all its
// optimal ways on and the smallest node sequence is read off from the start.
//
// Labels are (cost, raster steps) in lexicographic order. The lower bound
// (octile distance at the lowest cost, Chebyshev distance) is consistent in
// that order, so a popped node is final; among equal keys the node nearer to
// the goal comes first, so all ways on of a popped node are known. The search
// ends when no key is at or below the start's label: ties are complete.
// An edge is summed only when its end is popped and its beginning is not.
template <typename Arithmetic>
class LatticeSearch {
 public:
  LatticeSearch(const TerrainMap& map, Cell start, Cell goal,
                const LatticeOptions& options)
      : map_(map),
        costs_(map),
        lattice_(map, options.stride),
        start_(start),
        goal_(goal),
        start_box_(JointBox(lattice_, start, options.joints)),
        goal_box_(JointBox(lattice_, goal, options.joints)),
        nodes_(static_cast<std::size_t>(lattice_.cols) *
               static_cast<std::size_t>(lattice_.rows)) {}

  LatticePlan Run() {
    JoinGoal();
    while (!open_.empty()) {
      const Key key = open_.top();
      open_.pop();
      Node& node = nodes_[lattice_.Index(key.node)];
      if (node.closed) {
        continue;
      }
      if (std::tie(key.bound, key.bound_steps) >
          std::tie(start_cost_, start_steps_)) {
        break;
      }
      node.closed = true;
      ++plan_.expanded;
      Expand(key.node, node);
    }
    if (start_cost_ < Arithmetic::kUnreached) {
      plan_.status = SearchStatus::kFound;
      plan_.waypoints = Extract();
      plan_.cost = WalkRoute(map_, plan_.waypoints).cost;
    }
    return std::move(plan_);
  }

 private:
  using Cost = typename Arithmetic::Cost;

  struct Node {
    Cost cost = Arithmetic::kUnreached;  // From here to the goal.
    std::int32_t steps = 0;
    std::uint16_t ways_on = 0;  // Bits: optimal directions, kToGoal.
    bool closed = false;
  };

  struct Key {
    Cost bound;  // Of a route from the start through the node.
    std::int32_t bound_steps;
    std::int32_t steps;  // From the node to the goal.
    Cell node;

    friend bool operator>(const Key& a, const Key& b) {
      return std::tie(a.bound, a.bound_steps, a.steps) >
             std::tie(b.bound, b.bound_steps, b.steps);
    }
  };

  static std::int32_t Steps(Cell from, Cell to) {
    return static_cast<std::int32_t>(ChebyshevDistance(from, to));
  }

  // Start and goal stand for a node of their own cell.
  bool IsEnd(Cell cell) const { return cell == start_ || cell == goal_; }

  bool JoinsDirectly() const {
    const auto reaches = [this](const NodeBox& box, Cell end) {
      return end.x % lattice_.stride == 0 && end.y % lattice_.stride == 0 &&
             box.Contains({end.x / lattice_.stride, end.y / lattice_.stride});
    };
    return ChebyshevDistance(start_, goal_) <= 2 * lattice_.stride ||
           reaches(start_box_, goal_) || reaches(goal_box_, start_);
  }

  void JoinGoal() {
    if (JoinsDirectly()) {
      ++plan_.edges_costed;
      RelaxStart(goal_, costs_.Segment(start_, goal_), Steps(start_, goal_));
    }
    for (int j = goal_box_.low.y; j <= goal_box_.high.y; ++j) {
      for (int i = goal_box_.low.x; i <= goal_box_.high.x; ++i) {
        const Cell cell = lattice_.CellOf({i, j});
        if (IsEnd(cell) || !map_.Passable(cell)) {
          continue;
        }
        ++plan_.edges_costed;
        const Cost cost = costs_.Segment(cell, goal_);
        if (cost < Arithmetic::kUnreached) {
          Relax({i, j}, cost, Steps(cell, goal_), kToGoal);
        }
      }
    }
  }

  // Relaxes every edge that leads to `to`.
  void Expand(Cell to, const Node& node) {
    const Cell to_cell = lattice_.CellOf(to);
    for (int d = 0; d < kNumDirections; ++d) {
      const Cell from{to.x - kSteps[static_cast<std::size_t>(d)].x,
                      to.y - kSteps[static_cast<std::size_t>(d)].y};
      if (!lattice_.Contains(from) || nodes_[lattice_.Index(from)].closed) {
        continue;
      }
      const Cell from_cell = lattice_.CellOf(from);
      if (IsEnd(from_cell) || !map_.Passable(from_cell)) {
        continue;
      }
      ++plan_.edges_costed;
      const Cost cost = costs_.Run(from_cell, to_cell);
      if (cost < Arithmetic::kUnreached) {
        Relax(from, cost + node.cost, lattice_.stride + node.steps, 1U << d);
      }
    }
    if (start_box_.Contains(to)) {
      ++plan_.edges_costed;
      const Cost cost = costs_.Segment(start_, to_cell);
      if (cost < Arithmetic::kUnreached) {
        RelaxStart(to_cell, cost + node.cost,
                   Steps(start_, to_cell) + node.steps);
      }
    }
  }

  void Relax(Cell at, Cost cost, std::int32_t steps, unsigned way_on) {
    Node& node = nodes_[lattice_.Index(at)];
    if (std::tie(cost, steps) == std::tie(node.cost, node.steps)) {
      node.ways_on = static_cast<std::uint16_t>(node.ways_on | way_on);
    } else if (std::tie(cost, steps) < std::tie(node.cost, node.steps)) {
      node = {cost, steps, static_cast<std::uint16_t>(way_on), false};
      const Cell cell = lattice_.CellOf(at);
      open_.push({cost + costs_.LowerBound(start_, cell),
                  steps + Steps(start_, cell), steps, at});
    }
  }

  void RelaxStart(Cell next, Cost cost, std::int32_t steps) {
    if (std::tie(cost, steps) < std::tie(start_cost_, start_steps_)) {
      start_cost_ = cost;
      start_steps_ = steps;
      start_next_ = next;
    } else if (std::tie(cost, steps) == std::tie(start_cost_, start_steps_)) {
      start_next_ = FirstInRowOrder(start_next_, next);
    }
  }

  static Cell FirstInRowOrder(Cell a, Cell b) {
    return std::tie(a.y, a.x) < std::tie(b.y, b.x) ? a : b;
  }

  Route Extract() const {
    Route route = {start_, start_next_};
    while (route.back() != goal_) {
      const Cell cell = route.back();
      const Cell node{cell.x / lattice_.stride, cell.y / lattice_.stride};
      const unsigned ways_on = nodes_[lattice_.Index(node)].ways_on;
      Cell next = goal_;
      bool chosen = (ways_on & kToGoal) != 0;
      for (int d = 0; d < kNumDirections; ++d) {
        if ((ways_on & (1U << d)) != 0) {
          const Cell to =
              lattice_.CellOf({node.x + kSteps[static_cast<std::size_t>(d)].x,
                               node.y + kSteps[static_cast<std::size_t>(d)].y});
          next = chosen ? FirstInRowOrder(next, to) : to;
          chosen = true;
        }
      }
      route.push_back(next);
    }
    return route;
  }

  const TerrainMap& map_;
  StepCosts<Arithmetic> costs_;
  Lattice lattice_;
  Cell start_;
  Cell goal_;
  NodeBox start_box_;
  NodeBox goal_box_;
  std::vector<Node> nodes_;
  std::priority_queue<Key, std::vector<Key>, std::greater<>> open_;
  Cost start_cost_ = Arithmetic::kUnreached;
  std::int32_t start_steps_ = 0;
  Cell start_next_;
  LatticePlan plan_;
};

}  // namespace

LatticePlan PlanOnLattice(const TerrainMap& map, Cell start, Cell goal,
                          const LatticeOptions& options) {
  TERRA_REQUIRE(options.stride >= 1 && options.stride <= TerrainMap::kMaxSide);
  LatticePlan plan;
  plan.status = CheckSearchEnds(map, start, goal);
  if (!plan.found()) {
    return plan;
  }
  if (start == goal) {
    plan.waypoints = {start, goal};
    plan.cost = 0;
    return plan;
  }
  if (map.costs().scale != 0) {
    return LatticeSearch<ExactArithmetic>(map, start, goal, options).Run();
  }
  return LatticeSearch<DoubleArithmetic>(map, start, goal, options).Run();
}

}  // namespace terra::planner

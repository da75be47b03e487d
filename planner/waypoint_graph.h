#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "planner/coarse_lattice.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::planner {

/// A fixed graph of surveyed waypoints, apart from any map. Edges are straight
/// segments that may be driven both ways.
///
/// Threads: immutable.
class WaypointGraph {
 public:
  static constexpr std::size_t kMaxNodes = 100'000;
  static constexpr std::size_t kMaxEdges = 500'000;
  /// All edges together, in raster steps: bounds the work of a plan.
  static constexpr std::int64_t kMaxTotalSteps = 50'000'000;

  struct Node {
    std::string name;
    Cell cell;
  };
  using Edge = std::pair<std::size_t, std::size_t>;  ///< Indices of nodes.

  /// Pre: within the limits above, no edge from a node to itself (graph_file.h
  ///      checks what comes from a file).
  WaypointGraph(std::vector<Node> nodes, const std::vector<Edge>& edges);

  const std::vector<Node>& nodes() const { return nodes_; }
  /// The nodes that share an edge with this one.
  const std::vector<std::size_t>& Neighbours(std::size_t node) const {
    return neighbours_[node];
  }

 private:
  std::vector<Node> nodes_;
  std::vector<std::vector<std::size_t>> neighbours_;
};

/// How far start and goal may lie from a node. Units: cells.
inline constexpr int kDefaultReach = 100;
inline constexpr int kMaxReach = 1000;  ///< Bounds the work of joining them.

/// Finds the cheapest route from start to goal over the graph.
///
/// Edges cost their segment cost on the map in travel direction; those that are
/// not feasible there (a node outside the map included) do not exist. Segments
/// lead from the start to the nodes, from the nodes to the goal, and from start
/// to goal, within max(|dx|, |dy|) <= reach.
/// Pre:    reach is 0 to kMaxReach.
/// Ties: as on the lattice, fewest raster steps, then the smallest sequence of
///       cells in row order; neither names nor the order of nodes matter. Costs
///       are exact where CostTable has units, else sums of doubles.
/// Threads: reentrant.
/// Source: Dijkstra 1959 (Numerische Mathematik 1).
LatticePlan PlanOnGraph(const TerrainMap& map, const WaypointGraph& graph,
                        Cell start, Cell goal, int reach = kDefaultReach);

}  // namespace terra::planner

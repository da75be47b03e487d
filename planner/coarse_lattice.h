#pragma once

#include <cstdint>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/search_result.h"

namespace terra::planner {

/// How start and goal are joined to the lattice.
enum class JointRule {
  kTwoStrides,  ///< To every node within max(|dx|, |dy|) <= 2 stride.
  kCell,        ///< To the corners of the enclosing lattice cell only.
  kVisible,     ///< To every node that a feasible segment reaches.
};

struct LatticeOptions {
  int stride = 50;  ///< Cells; 1 to TerrainMap::kMaxSide.
  JointRule joints = JointRule::kTwoStrides;
};

/// The baseline route and what it took.
struct LatticePlan {
  SearchStatus status = SearchStatus::kNoRoute;
  /// start, lattice nodes, goal; two equal waypoints when start = goal.
  Route waypoints;
  double cost = kImpassable;  ///< Equals WalkRoute of the waypoints.
  std::int64_t expanded = 0;
  std::int64_t edges_costed = 0;

  bool found() const { return status == SearchStatus::kFound; }
};

/// Finds the cheapest route on a coarse 8-connected lattice.
///
/// Nodes lie at (i stride, j stride) inside the map; an edge exists when its
/// segment is feasible and costs its segment cost in travel direction. Segments
/// lead from the start to nodes and from nodes to the goal by the joint rule,
/// and from start to goal when within two strides.
/// Ties: fewest raster steps, then the smallest node sequence (row-major).
/// Threads: reentrant.
/// Source: paper, Problem Formulation and Experimental Setup; the joint rule
/// and
///         the tie rule are this project's choice (docs/decisions.md).
LatticePlan PlanOnLattice(const TerrainMap& map, Cell start, Cell goal,
                          const LatticeOptions& options = {});

}  // namespace terra::planner

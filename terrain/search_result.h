#pragma once

#include <cstddef>
#include <cstdint>

#include "terrain/cell.h"
#include "terrain/legend.h"

namespace terra {

enum class SearchStatus {
  kFound,
  kNoRoute,
  kStartOutside,
  kGoalOutside,
  kStartBlocked,
  kGoalBlocked,
};

/// What a search on the raster found and what it took.
struct SearchResult {
  SearchStatus status = SearchStatus::kNoRoute;
  /// kImpassable unless found; equals WalkRoute of the cells.
  double cost = kImpassable;
  /// A cheapest path cell by cell, start to goal; start = goal is one cell.
  ///
  /// Ties: one rule for every search on the raster. The path is chosen from the
  /// goal back. Of the neighbours over which a cheapest path leads to the cell,
  /// the one straight ahead is taken, else the first clockwise from there; at
  /// the goal, the first clockwise from east (to the right, x rising). So there
  /// are few corners, and the same map gives the same path whatever finds it.
  CellPath cells;
  /// Work done: cells expanded (or visited by a sweep, each visit counted).
  std::int64_t expanded = 0;
  int passes = 0;         ///< Over the rows, of a sweep; else 0.
  std::size_t bytes = 0;  ///< Working memory of a native search.

  bool found() const { return status == SearchStatus::kFound; }
};

}  // namespace terra

#pragma once

#include <cstdint>

#include "terrain/cell.h"

namespace terra {

/// What one attempt at a native search, with one kind of keys, came to.
struct SearchAttempt {
  bool found = false;
  /// Not found, but paths were dropped because keys of this kind do not hold
  /// them: wider ones may find a path.
  bool beyond_keys = false;
  CellPath cells;
  std::int64_t expanded = 0;  ///< Cells expanded, or relaxed by a sweep.
  int passes = 0;             ///< Of a sweep.
};

}  // namespace terra

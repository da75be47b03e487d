#pragma once

#include "terrain/map.h"
#include "terrain/search_result.h"

namespace terra {

/// Returns kFound when a search may start, else what is wrong with its ends.
inline SearchStatus CheckSearchEnds(const TerrainMap& map, Cell start,
                                    Cell goal) {
  if (!map.Contains(start)) return SearchStatus::kStartOutside;
  if (!map.Contains(goal)) return SearchStatus::kGoalOutside;
  if (!map.Passable(start)) return SearchStatus::kStartBlocked;
  if (!map.Passable(goal)) return SearchStatus::kGoalBlocked;
  return SearchStatus::kFound;
}

}  // namespace terra

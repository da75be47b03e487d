#pragma once

#include <algorithm>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/require.h"
#include "terrain/search_steps.h"

namespace terra {

/// Reads the path to the goal back out of the keys a search has left: each
/// cell's predecessor is a neighbour over which its key is not exceeded, if
/// possible the one straight ahead, so that paths have few corners.
///
/// key_of(index) is the key of a cell of the CostGrid, at least Keys::kLimit
/// where it has none. A labelled cell other than the start was labelled from a
/// neighbour whose key can only have fallen since. So there is a predecessor,
/// the steps of the path sum up to the goal's key at most, and as keys fall on
/// the way it ends at the start. Keys of which that is not true are a caller's
/// bug and end it too.
template <typename Keys, typename KeyOf>
CellPath ExtractPath(const TerrainMap& map, const Keys& keys, Cell start,
                     Cell goal, const KeyOf& key_of) {
  using Key = typename Keys::Key;
  const GridSteps grid(map);
  CellPath path = {goal};
  std::size_t ahead = 0;
  while (path.back() != start) {
    const std::size_t index = map.cost_grid().Index(path.back());
    const Key key = key_of(index);
    const Key straight = keys.Straight(grid.Code(index));
    const Key diagonal = keys.Diagonal(grid.Code(index));
    const auto leads_here = [&](std::size_t d) {
      const Key before = key_of(grid.Neighbour(index, d));
      return before < key &&
             before + (d % 2 == 0 ? straight : diagonal) <= key &&
             grid.MayPassCorner(index, d);
    };
    std::size_t turns = 0;
    while (!leads_here(ahead)) {
      TERRA_REQUIRE(++turns < kSteps.size());
      ahead = (ahead + 1) % kSteps.size();
    }
    const Cell from = path.back();
    path.push_back(Cell{from.x + kSteps[ahead].x, from.y + kSteps[ahead].y});
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace terra

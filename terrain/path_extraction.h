#pragma once

#include <algorithm>
#include <optional>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/require.h"
#include "terrain/search_steps.h"

namespace terra {

/// Reads the path to the goal back out of the keys a search has left: each
/// cell's predecessor is the neighbour from which it is reached at the lowest
/// key, of equal ones the one straight ahead, so that paths have few corners.
///
/// key_of(index) is the key of a cell of the CostGrid, at least Keys::kLimit
/// where it has none. A labelled cell other than the start was labelled from a
/// neighbour whose key can only have fallen since, so keys fall on the way and
/// it ends at the start. Keys of which that is not true are a caller's bug and
/// end it too.
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
    std::optional<std::size_t> best;
    Key best_key = Keys::kLimit;
    for (std::size_t turn = 0; turn < kSteps.size(); ++turn) {
      const std::size_t d = (ahead + turn) % kSteps.size();
      const Key before = key_of(grid.Neighbour(index, d));
      if (before >= key || !grid.MayPassCorner(index, d)) {
        continue;
      }
      const Key through = before + (d % 2 == 0 ? straight : diagonal);
      if (!best || through < best_key) {
        best = d;
        best_key = through;
      }
    }
    TERRA_REQUIRE(best.has_value());
    ahead = *best;
    const Cell from = path.back();
    path.push_back(Cell{from.x + kSteps[ahead].x, from.y + kSteps[ahead].y});
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace terra

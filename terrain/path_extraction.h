#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/octile_paths.h"
#include "terrain/require.h"
#include "terrain/search_keys.h"
#include "terrain/search_steps.h"

namespace terra {

/// Reads the path out of the keys that a search has left, by the one tie rule
/// of all searches on the raster (SearchResult::cells): from the goal back, of
/// the neighbours over which a cheapest path leads to the cell, the one
/// straight ahead, else the first clockwise from there; from the goal,
/// clockwise from east.
///
/// The rule speaks of all cheapest paths, so the cells of all of them must have
/// their final key, but for those whose key and octile bound to the goal add up
/// to the goal's key. From such a cell on, the path crosses nothing but the
/// cheapest ground and leads straight to the goal; it can be walked back
/// without labels. A search that leaves out such cells names others of their
/// kind, the sources, so that each of them lies on an octile path from a source
/// to the goal. Where a walk without labels comes to no labelled cell it is
/// taken back, and what it saw is marked, so that no cell is looked at twice.
///
/// Labels has the keys by the index of cells in the CostGrid:
///   Key At(index)          the cell's key; at least kLimit where it has none;
///   bool IsMarked(index),
///   void Mark(index)       for cells without a final key.
/// Keys of which all this is not true are a caller's bug and end in an error.
template <typename Keys, typename Labels>
class PathExtraction {
 public:
  using Key = typename Keys::Key;

  /// Without sources no cell may lack its key.
  PathExtraction(const TerrainMap& map, const Keys& keys, Cell start, Cell goal,
                 Labels& labels, const std::vector<Cell>& sources = {})
      : map_(map),
        keys_(keys),
        grid_(map),
        to_goal_(keys, goal),
        start_(start),
        goal_(goal),
        labels_(labels),
        total_(labels.At(map.cost_grid().Index(goal))),
        has_sources_(!sources.empty()),
        behind_sources_(sources, goal) {}

  CellPath Run() {
    Stand at{goal_, map_.cost_grid().Index(goal_), total_, 0, 0};
    while (at.cell != start_) {
      if (const auto before = Next(at)) {
        path_.push_back(at);
        at = *before;
      } else {
        // Nothing leads here: the cell was tried without a label.
        TERRA_REQUIRE(!path_.empty());
        labels_.Mark(at.index);
        at = path_.back();
        path_.pop_back();
        ++at.turns;
      }
    }
    CellPath cells = {start_};
    for (auto stand = path_.rbegin(); stand != path_.rend(); ++stand) {
      cells.push_back(stand->cell);
    }
    return cells;
  }

 private:
  // A cell of the path, on the way back from the goal.
  struct Stand {
    Cell cell;
    std::size_t index;
    Key key;
    std::uint8_t ahead;  // The step that led here.
    std::uint8_t turns;  // From there to the step that is to be tried next.
  };

  // The next cell on the way back; none when all steps have been tried.
  std::optional<Stand> Next(Stand& at) const {
    const std::uint16_t code = grid_.Code(at.index);
    const Key straight = keys_.Straight(code);
    const Key diagonal = keys_.Diagonal(code);
    const Key to_goal = to_goal_(at.cell.x, at.cell.y);
    const bool may_lack_labels = has_sources_ && at.key + to_goal == total_;
    for (; at.turns < kSteps.size(); ++at.turns) {
      const std::size_t d = (at.ahead + at.turns) % kSteps.size();
      const std::size_t index = grid_.Neighbour(at.index, d);
      const Key step = d % 2 == 0 ? straight : diagonal;
      const Key label = labels_.At(index);
      const bool leads_here = label < at.key && label + step == at.key;
      if (!leads_here && !may_lack_labels) continue;
      const Cell cell{at.cell.x + kSteps[d].x, at.cell.y + kSteps[d].y};
      if ((leads_here || MayLeadHere(cell, index, step + to_goal)) &&
          grid_.MayPassCorner(at.index, d)) {
        return Stand{cell, index, at.key - step, static_cast<std::uint8_t>(d),
                     0};
      }
    }
    return std::nullopt;
  }

  // Whether a neighbour without a final key may be on a cheapest path, as far
  // as its place tells: its octile bound must be what the way on costs.
  bool MayLeadHere(Cell cell, std::size_t index, Key to_goal) const {
    return grid_.Code(index) != 0 && !labels_.IsMarked(index) &&
           to_goal_(cell.x, cell.y) == to_goal && behind_sources_.Contain(cell);
  }

  const TerrainMap& map_;
  const Keys& keys_;
  const GridSteps grid_;
  const OctileBound<Keys> to_goal_;
  const Cell start_;
  const Cell goal_;
  Labels& labels_;
  const Key total_;
  const bool has_sources_;
  const OctilePaths behind_sources_;
  std::vector<Stand> path_;
};

}  // namespace terra

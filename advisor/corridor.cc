#include "advisor/corridor.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "advisor/route_moves.h"
#include "terrain/path_extraction.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/search_attempt.h"
#include "terrain/search_ends.h"
#include "terrain/search_keys.h"
#include "terrain/search_steps.h"
#include "terrain/segment.h"

namespace terra::advisor {
namespace {

constexpr std::uint8_t kMarked = 1;
constexpr std::uint8_t kReached = 2;

// Sets every cell that has a marked one in its row within a distance.
void SpreadAlongRows(ByteRaster& raster, int distance) {
  for (Eigen::Index y = 0; y < raster.rows(); ++y) {
    const auto reach = [&, since = distance + 1](Eigen::Index x) mutable {
      since = raster(y, x) == kMarked ? 0 : since + 1;
      if (since > 0 && since <= distance) raster(y, x) = kReached;
    };
    auto from_left = reach;
    for (Eigen::Index x = 0; x < raster.cols(); ++x) from_left(x);
    auto from_right = reach;
    for (Eigen::Index x = raster.cols(); x-- > 0;) from_right(x);
  }
  raster = (raster != 0).cast<std::uint8_t>();  // All reached ones are marked.
}

// A* over the corridor's cells. It goes on while a path of the goal's key may
// come, so that the tie rule finds the final keys of all cheapest paths.
class CorridorSearch {
 public:
  using Key = RoundedKeys::Key;

  CorridorSearch(const TerrainMap& map, const Corridor& corridor,
                 const RoundedKeys& keys, Cell goal)
      : map_(map),
        corridor_(corridor),
        keys_(keys),
        grid_(map),
        to_goal_(keys, goal),
        goal_(goal),
        labels_(static_cast<std::size_t>(corridor.width()) *
                    static_cast<std::size_t>(corridor.height()),
                RoundedKeys::kNone) {}

  SearchAttempt Run(Cell start) {
    Reach(start, 0);
    while (!open_.empty() && open_.top().total <= LabelOf(goal_)) {
      const Entry entry = open_.top();
      open_.pop();
      if (entry.key > LabelOf(entry.cell)) continue;  // A better one came.
      ++attempt_.expanded;
      Expand(entry);
    }
    if (LabelOf(goal_) < RoundedKeys::kLimit) {
      attempt_.found = true;
      attempt_.beyond_keys = false;
      attempt_.cells = PathExtraction(map_, keys_, start, goal_, *this).Run();
    }
    return std::move(attempt_);
  }

  // Labels as PathExtraction asks for them. None is ever missing.
  Key At(std::size_t index) const {
    const Cell cell = map_.cost_grid().CellAt(index);
    return corridor_.Contains(cell) ? LabelOf(cell) : RoundedKeys::kNone;
  }
  bool IsMarked(std::size_t /*index*/) const { return true; }
  void Mark(std::size_t /*index*/) {}

 private:
  struct Entry {
    Key total;  // Of a path from start to goal through the cell, at least.
    Key key;
    Cell cell;

    friend bool operator>(const Entry& a, const Entry& b) {
      return a.total > b.total;
    }
  };

  std::size_t Place(Cell c) const {
    const Cell origin = corridor_.origin();
    return static_cast<std::size_t>(c.y - origin.y) *
               static_cast<std::size_t>(corridor_.width()) +
           static_cast<std::size_t>(c.x - origin.x);
  }
  Key LabelOf(Cell c) const { return labels_[Place(c)]; }

  void Reach(Cell c, Key key) {
    if (key >= LabelOf(c)) return;
    const Key total = key + to_goal_(c.x, c.y);
    if (total >= RoundedKeys::kLimit) {
      attempt_.beyond_keys = true;
      return;
    }
    labels_[Place(c)] = key;
    open_.push({total, key, c});
  }

  void Expand(const Entry& entry) {
    const std::size_t index = map_.cost_grid().Index(entry.cell);
    for (std::size_t d = 0; d < kSteps.size(); ++d) {
      const Cell to{entry.cell.x + kSteps[d].x, entry.cell.y + kSteps[d].y};
      const std::uint16_t code = grid_.Code(grid_.Neighbour(index, d));
      if (code == 0 || !corridor_.Contains(to) ||
          !grid_.MayPassCorner(index, d)) {
        continue;
      }
      Reach(to, entry.key +
                    (d % 2 == 0 ? keys_.Straight(code) : keys_.Diagonal(code)));
    }
  }

  const TerrainMap& map_;
  const Corridor& corridor_;
  const RoundedKeys& keys_;
  const GridSteps grid_;
  const OctileBound<RoundedKeys> to_goal_;
  const Cell goal_;
  std::vector<Key> labels_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
  SearchAttempt attempt_;
};

}  // namespace

Corridor::Corridor(const TerrainMap& map, std::span<const Route> routes,
                   int half_width) {
  TERRA_REQUIRE(half_width >= 0);
  Cell low{map.width(), map.height()};
  Cell high{-1, -1};
  for (const Route& route : routes) {
    for (const Cell c : route) {
      TERRA_REQUIRE(map.Contains(c));
      low = {std::min(low.x, c.x), std::min(low.y, c.y)};
      high = {std::max(high.x, c.x), std::max(high.y, c.y)};
    }
  }
  TERRA_REQUIRE(high.x >= 0);
  // Wider than the map is as wide as the map.
  const int reach = std::min(half_width, TerrainMap::kMaxSide);
  origin_ = {std::max(low.x - reach, 0), std::max(low.y - reach, 0)};
  inside_ = ByteRaster::Zero(
      std::min(high.y + reach, map.height() - 1) - origin_.y + 1,
      std::min(high.x + reach, map.width() - 1) - origin_.x + 1);
  for (const Route& route : routes) {
    for (std::size_t i = 0; i < route.size(); ++i) {
      SegmentCells cells(route[i == 0 ? 0 : i - 1], route[i]);
      for (;; cells.Next()) {
        const Cell c = cells.cell();
        inside_(c.y - origin_.y, c.x - origin_.x) = kMarked;
        if (cells.done()) break;
      }
    }
  }
  SpreadAlongRows(inside_, reach);
  ByteRaster columns = inside_.transpose();
  SpreadAlongRows(columns, reach);
  inside_ = columns.transpose();
}

SearchResult SearchCorridor(const TerrainMap& map, const Corridor& corridor,
                            Cell start, Cell goal) {
  SearchResult result;
  result.status = CheckSearchEnds(map, start, goal);
  if (!result.found()) return result;
  if (!corridor.Contains(start) || !corridor.Contains(goal)) {
    result.status = SearchStatus::kNoRoute;
    return result;
  }
  const int num_levels = RoundedKeys::NumLevels(map);
  SearchAttempt last;
  last.beyond_keys = true;
  for (int level = 0; last.beyond_keys && level < num_levels; ++level) {
    const RoundedKeys keys(map, level);
    last = CorridorSearch(map, corridor, keys, goal).Run(start);
    result.expanded += last.expanded;
  }
  if (!last.found) {
    result.status = SearchStatus::kNoRoute;
    return result;
  }
  result.cost = WalkRoute(map, last.cells).cost;
  result.cells = std::move(last.cells);
  return result;
}

Route RouteInCorridor(const TerrainMap& map, const Corridor& corridor,
                      Cell start, Cell goal) {
  const SearchResult found = SearchCorridor(map, corridor, start, goal);
  if (!found.found()) return {};
  return ThinWaypoints(CornersOf(found.cells), [&](Cell from, Cell to) {
    for (SegmentCells cells(from, to); !cells.done();) {
      cells.Next();
      if (!corridor.Contains(cells.cell())) return kImpassable;
    }
    return SegmentCost(map, from, to);
  });
}

}  // namespace terra::advisor

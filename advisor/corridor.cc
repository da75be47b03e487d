#include "advisor/corridor.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numbers>
#include <queue>
#include <vector>

#include "advisor/route_moves.h"
#include "terrain/require.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"
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

double OctileDistance(Cell a, Cell b) {
  const int dx = std::abs(a.x - b.x);
  const int dy = std::abs(a.y - b.y);
  return std::max(dx, dy) + (std::numbers::sqrt2 - 1) * std::min(dx, dy);
}

class CorridorSearch {
 public:
  CorridorSearch(const TerrainMap& map, const Corridor& corridor, Cell goal)
      : map_(map),
        corridor_(corridor),
        goal_(goal),
        labels_(static_cast<std::size_t>(corridor.width()) *
                static_cast<std::size_t>(corridor.height())) {}

  SearchResult Run(Cell start) {
    SearchResult result;
    Reach(start, 0, kNoDirection);
    while (!open_.empty()) {
      const Entry entry = open_.top();
      open_.pop();
      if (entry.cost > At(entry.cell).cost) continue;  // A better one came.
      ++result.expanded;
      if (entry.cell == goal_) {
        result.status = SearchStatus::kFound;
        result.cells = PathFrom(start);
        result.cost = WalkRoute(map_, result.cells).cost;
        break;
      }
      Expand(entry);
    }
    return result;
  }

 private:
  static constexpr std::uint8_t kNoDirection = 8;

  struct Label {
    double cost = kImpassable;  // From the start.
    std::uint8_t arrival = kNoDirection;
  };
  struct Entry {
    double bound;  // Of a path from start to goal through the cell.
    double cost;
    Cell cell;

    friend bool operator>(const Entry& a, const Entry& b) {
      return a.bound > b.bound;
    }
  };

  Label& At(Cell c) {
    const Cell origin = corridor_.origin();
    return labels_[static_cast<std::size_t>(c.y - origin.y) *
                       static_cast<std::size_t>(corridor_.width()) +
                   static_cast<std::size_t>(c.x - origin.x)];
  }

  void Reach(Cell c, double cost, std::uint8_t arrival) {
    Label& label = At(c);
    if (cost >= label.cost) return;
    label = {cost, arrival};
    open_.push(
        {cost + map_.costs().min_cost() * OctileDistance(c, goal_), cost, c});
  }

  void Expand(const Entry& entry) {
    const Cell from = entry.cell;
    for (std::uint8_t d = 0; d < kSteps.size(); ++d) {
      const Cell to{from.x + kSteps[d].x, from.y + kSteps[d].y};
      if (!corridor_.Contains(to) || !map_.Passable(to)) continue;
      const bool diagonal = d % 2 == 1;
      if (diagonal && !map_.cost_model().corner_cutting &&
          (!map_.Passable({from.x, to.y}) || !map_.Passable({to.x, from.y}))) {
        continue;
      }
      const double length = diagonal ? std::numbers::sqrt2 : 1;
      Reach(to, entry.cost + length * map_.Cost(to), d);
    }
  }

  CellPath PathFrom(Cell start) {
    CellPath cells = {goal_};
    while (cells.back() != start) {
      const Cell step = kSteps[At(cells.back()).arrival];
      cells.push_back({cells.back().x - step.x, cells.back().y - step.y});
    }
    std::reverse(cells.begin(), cells.end());
    return cells;
  }

  const TerrainMap& map_;
  const Corridor& corridor_;
  Cell goal_;
  std::vector<Label> labels_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
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
  return CorridorSearch(map, corridor, goal).Run(start);
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

#include "benchmark/single_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "terrain/route_cost.h"
#include "terrain/segment.h"

namespace terra::benchmark {
namespace {

struct OpenCell {
  double f = 0;
  double g = 0;
  Cell cell;
};

// The heap's order: the lowest f on top, then the smallest cell, so that the
// result is the same everywhere.
bool Later(const OpenCell& a, const OpenCell& b) {
  return a.f != b.f ? a.f > b.f : a.cell > b.cell;
}

class Search {
 public:
  Search(const TerrainMap& map, Cell goal, Route targets)
      : map_(map),
        goal_(goal),
        targets_(std::move(targets)),
        g_(Size(), kImpassable),
        came_from_(Size()) {}

  CellPath Run(Cell start) {
    g_[Index(start)] = 0;
    came_from_[Index(start)] = start;
    Push(start, 0);
    while (!open_.empty()) {
      std::pop_heap(open_.begin(), open_.end(), Later);
      const OpenCell next = open_.back();
      open_.pop_back();
      if (next.g > g_[Index(next.cell)]) continue;  // Improved since.
      if (next.cell == goal_) return PathFrom(start);
      Expand(next);
    }
    return {};
  }

 private:
  std::size_t Size() const {
    return static_cast<std::size_t>(map_.width()) *
           static_cast<std::size_t>(map_.height());
  }
  std::size_t Index(Cell c) const {
    return static_cast<std::size_t>(c.y) *
               static_cast<std::size_t>(map_.width()) +
           static_cast<std::size_t>(c.x);
  }
  double Distance(Cell a, Cell b) const {
    // Not std::hypot, whose last bit is the library's business.
    const double dx = a.x - b.x;
    const double dy = a.y - b.y;
    return map_.costs().min_cost() * std::sqrt(dx * dx + dy * dy);
  }
  double Value(Cell c, double g) const {
    const Cell target = target_ < targets_.size() ? targets_[target_] : goal_;
    return g + Distance(c, goal_) + Distance(c, target);
  }

  void Push(Cell c, double g) {
    open_.push_back({Value(c, g), g, c});
    std::push_heap(open_.begin(), open_.end(), Later);
  }

  void Expand(const OpenCell& from) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell to{from.cell.x + dx, from.cell.y + dy};
        if (to == from.cell || !map_.Contains(to)) continue;
        const double step = SegmentCost(map_, from.cell, to);
        const double g = from.g + step;
        if (step == kImpassable || g >= g_[Index(to)]) continue;
        g_[Index(to)] = g;
        came_from_[Index(to)] = from.cell;
        Push(to, g);
        if (target_ < targets_.size() && to == targets_[target_]) {
          NextTarget();
        }
      }
    }
  }

  void NextTarget() {
    ++target_;
    for (OpenCell& open : open_) open.f = Value(open.cell, open.g);
    std::make_heap(open_.begin(), open_.end(), Later);
  }

  CellPath PathFrom(Cell start) const {
    CellPath path = {goal_};
    while (path.back() != start) {
      path.push_back(came_from_[Index(path.back())]);
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

  const TerrainMap& map_;
  const Cell goal_;
  const Route targets_;
  std::size_t target_ = 0;
  std::vector<OpenCell> open_;
  std::vector<double> g_;
  std::vector<Cell> came_from_;
};

}  // namespace

Route SingleTargetedSearch(const TerrainMap& map, Cell start, Cell goal,
                           const Route& targets) {
  Route reachable = targets;
  std::erase_if(reachable, [&](Cell c) {
    return !map.Contains(c) || !map.Passable(c) || c == start || c == goal;
  });
  const CellPath path = Search(map, goal, std::move(reachable)).Run(start);
  return path.empty() ? Route{} : CornersOf(path);
}

}  // namespace terra::benchmark

#include "tests/terrain/ruled_path.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "terrain/search_keys.h"

namespace terra::testing {
namespace {

__extension__ using Int128 = __int128;

// straight + diagonal sqrt 2.
struct Sum {
  std::int64_t straight = 0;
  std::int64_t diagonal = 0;

  friend Sum operator+(Sum a, Sum b) {
    return {a.straight + b.straight, a.diagonal + b.diagonal};
  }
  friend bool operator==(Sum a, Sum b) = default;
  // a < b when (a - b) = s + d sqrt 2 is negative, which squares tell.
  friend bool operator<(Sum a, Sum b) {
    const Int128 s = a.straight - b.straight;
    const Int128 d = a.diagonal - b.diagonal;
    if (s >= 0 && d >= 0) return false;
    if (s <= 0 && d <= 0) return true;
    return s < 0 ? s * s > 2 * d * d : s * s < 2 * d * d;
  }
};

// East, then clockwise.
constexpr Cell kClockwise[] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                               {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

// What a step into a cell costs: exact units where the legend has them, else
// the integers to which the documented rounding leads.
class StepSums {
 public:
  StepSums(const TerrainMap& map, int level) : map_(map), keys_(map, level) {}

  Sum Into(Cell to, bool diagonal) const {
    const auto cost_class =
        static_cast<std::size_t>(map_.classes()(to.y, to.x));
    if (map_.costs().scale != 0) {
      const std::int64_t units = map_.costs().units[cost_class];
      return diagonal ? Sum{0, units} : Sum{units, 0};
    }
    const auto code = static_cast<std::uint16_t>(cost_class);
    return {static_cast<std::int64_t>(diagonal ? keys_.Diagonal(code)
                                               : keys_.Straight(code)),
            0};
  }

 private:
  const TerrainMap& map_;
  RoundedKeys keys_;
};

class RuledSearch {
 public:
  RuledSearch(const TerrainMap& map, int level)
      : map_(map),
        steps_(map, level),
        sums_(static_cast<std::size_t>(map.ids().size())) {}

  CellPath Run(Cell start, Cell goal) {
    Settle(start);
    if (!At(goal)) return {};
    CellPath path = {goal};
    int ahead = 0;
    while (path.back() != start) {
      int turns = 0;
      while (!LeadsTo(path.back(), (ahead + turns) % 8)) ++turns;
      ahead = (ahead + turns) % 8;
      path.push_back(Beside(path.back(), ahead));
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

  Sum SumAt(Cell c) { return *At(c); }

 private:
  static Cell Beside(Cell c, int direction) {
    return {c.x + kClockwise[direction].x, c.y + kClockwise[direction].y};
  }

  std::optional<Sum>& At(Cell c) {
    return sums_[static_cast<std::size_t>(c.y) *
                     static_cast<std::size_t>(map_.width()) +
                 static_cast<std::size_t>(c.x)];
  }

  // Whether the cost model has a step from one cell to a neighbour.
  bool MayStep(Cell from, Cell to) const {
    if (!map_.Contains(from) || !map_.Contains(to)) return false;
    if (!map_.Passable(from) || !map_.Passable(to)) return false;
    if (map_.cost_model().corner_cutting) return true;
    return map_.Passable({to.x, from.y}) && map_.Passable({from.x, to.y});
  }

  // Whether a cheapest path enters a cell from a direction.
  bool LeadsTo(Cell to, int direction) {
    const Cell from = Beside(to, direction);
    return MayStep(from, to) && At(from) &&
           *At(from) + steps_.Into(to, direction % 2 == 1) == *At(to);
  }

  void Settle(Cell start) {
    using Entry = std::pair<Sum, Cell>;
    const auto later = [](const Entry& a, const Entry& b) {
      return b.first < a.first;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> open(later);
    At(start) = Sum{};
    open.emplace(Sum{}, start);
    while (!open.empty()) {
      const auto [sum, cell] = open.top();
      open.pop();
      if (*At(cell) < sum) continue;
      for (int d = 0; d < 8; ++d) {
        const Cell to = Beside(cell, d);
        if (!MayStep(cell, to)) continue;
        const Sum over = sum + steps_.Into(to, d % 2 == 1);
        if (At(to) && !(over < *At(to))) continue;
        At(to) = over;
        open.emplace(over, to);
      }
    }
  }

  const TerrainMap& map_;
  StepSums steps_;
  std::vector<std::optional<Sum>> sums_;
};

}  // namespace

CellPath RuledPath(const TerrainMap& map, Cell start, Cell goal) {
  if (map.costs().num_classes == 0) return {};
  constexpr auto kLimit = static_cast<std::int64_t>(RoundedKeys::kLimit);
  for (int level = 0; level < RoundedKeys::NumLevels(map); ++level) {
    RuledSearch search(map, level);
    CellPath path = search.Run(start, goal);
    // Exact units know no levels.
    if (map.costs().scale != 0 || path.empty() ||
        search.SumAt(goal).straight < kLimit) {
      return path;
    }
  }
  return {};
}

}  // namespace terra::testing

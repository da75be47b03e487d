#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "terrain/cell.h"

namespace terra {

/// The cells of all octile paths from some cells to a goal: those of as many
/// diagonal and straight steps as the octile distance counts.
///
/// Seen from the goal, in each eighth of the map, a cell is `diagonal` steps
/// and `straight` steps away, and an octile path lowers one of them at a time.
/// So a cell is on one if a source is at least as far away in both.
class OctilePaths {
 public:
  OctilePaths(const std::vector<Cell>& sources, Cell goal) : goal_(goal) {
    // The goal is on all of them, in each eighth.
    if (!sources.empty()) most_straight_.fill({0});
    for (const Cell source : sources) {
      const Place place = PlaceOf(source);
      std::vector<int>& most = most_straight_[place.eighth];
      if (most.size() <= place.diagonal) most.resize(place.diagonal + 1, -1);
      most[place.diagonal] = std::max(most[place.diagonal], place.straight);
    }
    for (std::vector<int>& most : most_straight_) {
      for (std::size_t i = most.size(); i-- > 1;) {
        most[i - 1] = std::max(most[i - 1], most[i]);
      }
    }
  }

  bool Contain(Cell cell) const {
    const Place place = PlaceOf(cell);
    // A cell on the border of two eighths is in both.
    return InEighth(place, place.eighth) ||
           (place.straight == 0 && InEighth(place, place.eighth ^ 1U)) ||
           (cell.x == goal_.x && InEighth(place, place.eighth ^ 2U)) ||
           (cell.y == goal_.y && InEighth(place, place.eighth ^ 4U));
  }

 private:
  struct Place {
    std::size_t eighth;  // Bits: steeper than a diagonal, west, north.
    std::size_t diagonal;
    int straight;
  };

  Place PlaceOf(Cell cell) const {
    const int dx = std::abs(cell.x - goal_.x);
    const int dy = std::abs(cell.y - goal_.y);
    return {(dy > dx ? 1U : 0U) | (cell.x < goal_.x ? 2U : 0U) |
                (cell.y < goal_.y ? 4U : 0U),
            static_cast<std::size_t>(std::min(dx, dy)), std::abs(dx - dy)};
  }

  bool InEighth(const Place& place, std::size_t eighth) const {
    const std::vector<int>& most = most_straight_[eighth];
    return place.diagonal < most.size() &&
           place.straight <= most[place.diagonal];
  }

  Cell goal_;
  // By eighth and diagonal steps: the most straight steps of a source that is
  // at least as many diagonal steps away.
  std::array<std::vector<int>, 8> most_straight_;
};

}  // namespace terra

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include "terrain/cell.h"

namespace terra {

/// The steps of a segment on a raster stored row by row, as offsets to add to a
/// pointer: visits the cells of SegmentCells (segment.h), for loops that have
/// no time for coordinates.
///
/// Each step goes along the segment's longer side, and along the shorter one
/// too when twice the error is at most the longer side.
/// Pre: both ends inside the raster, which is `width` cells wide.
class SegmentSteps {
 public:
  SegmentSteps(Cell from, Cell to, int width)
      : along_longer_(to.x < from.x ? -1 : 1),
        along_shorter_(to.y < from.y ? -width : width) {
    const int dx = std::abs(to.x - from.x);
    const int dy = std::abs(to.y - from.y);
    if (dx < dy) {
      std::swap(along_longer_, along_shorter_);
    }
    longer_ = std::max(dx, dy);
    shorter_ = std::min(dx, dy);
    error_ = longer_ - shorter_;
  }

  int count() const { return longer_; }
  std::ptrdiff_t along_longer() const { return along_longer_; }
  std::ptrdiff_t along_shorter() const { return along_shorter_; }

  /// Takes a step. Returns whether it is a diagonal one, along both sides; else
  /// it is one along the longer.
  bool NextIsDiagonal() {
    const bool diagonal = 2 * error_ <= longer_;
    error_ += diagonal ? longer_ - shorter_ : -shorter_;
    return diagonal;
  }

 private:
  std::ptrdiff_t along_longer_;
  std::ptrdiff_t along_shorter_;
  int longer_;
  int shorter_;
  int error_;
};

}  // namespace terra

#pragma once

#include <cstdint>

#include "terrain/cell.h"

namespace terra {

/// Visits the cells of a straight segment, in travel order, one Next() a step.
///
/// Frame:  map cells; +x right, +y down.
/// Shape:  1 + max(|dx|, |dy|) cells, the first is `from`, the last is `to`;
///         each step moves to one of the 8 neighbours.
/// Ties:   a crossing exactly half-way takes the minor step: (0,0)-(2,1) visits
///         (1,1). The reversed segment may therefore visit other cells; never
///         sort the ends, cost is charged to the cell entered.
/// Errors: none; not clipped to any map, no overflow for any int coordinates.
/// Source: Bresenham 1965 (IBM Systems Journal 4:1), all-quadrant integer form;
///         paper, Problem Formulation.
class SegmentCells {
 public:
  SegmentCells(Cell from, Cell to)
      : cell_(from),
        to_(to),
        dx_(std::abs(std::int64_t{to.x} - from.x)),
        dy_(-std::abs(std::int64_t{to.y} - from.y)),
        step_x_(from.x < to.x ? 1 : -1),
        step_y_(from.y < to.y ? 1 : -1),
        error_(dx_ + dy_) {}

  Cell cell() const { return cell_; }
  bool done() const { return cell_ == to_; }

  /// Moves to the next cell; not to be called when done().
  void Next() {
    const std::int64_t twice = 2 * error_;
    if (twice >= dy_) {
      error_ += dy_;
      cell_.x += step_x_;
    }
    if (twice <= dx_) {
      error_ += dx_;
      cell_.y += step_y_;
    }
  }

 private:
  Cell cell_;
  Cell to_;
  std::int64_t dx_;
  std::int64_t dy_;
  int step_x_;
  int step_y_;
  std::int64_t error_;
};

/// Returns all cells of a segment.
CellPath RasterizeSegment(Cell from, Cell to);

/// Returns the cells of a whole route; cells that repeat in succession (segment
/// joints, repeated waypoints) come once. An empty route has no cells.
CellPath RasterizeRoute(const Route& route);

/// Returns the corners of a cell path: the first and last cell and each cell
/// where the step direction changes. Rasterised again it gives the same cells.
/// A path of one cell gives a route of two equal waypoints.
Route CornersOf(const CellPath& path);

}  // namespace terra

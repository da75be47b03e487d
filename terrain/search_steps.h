#pragma once

#include <array>
#include <cstddef>

#include "terrain/cell.h"
#include "terrain/cost_grid.h"
#include "terrain/map.h"
#include "terrain/steps.h"

namespace terra {

/// Walks a CostGrid by index, for searches.
class GridSteps {
 public:
  explicit GridSteps(const TerrainMap& map)
      : cells_(map.cost_grid().data()),
        corner_cutting_(map.cost_model().corner_cutting) {
    for (std::size_t d = 0; d < kSteps.size(); ++d) {
      offset_[d] = kSteps[d].y * map.cost_grid().stride() + kSteps[d].x;
    }
  }

  /// Index of the cell that step d leads to.
  std::size_t Neighbour(std::size_t index, std::size_t d) const {
    return index + static_cast<std::size_t>(offset_[d]);  // May wrap around.
  }
  /// Cost code of a cell; 0 = blocked.
  std::uint16_t Code(std::size_t index) const {
    return cells_[index] & CostGrid::kCodeMask;
  }
  bool InUniformBlock(std::size_t index) const {
    return (cells_[index] & CostGrid::kUniformBit) != 0;
  }
  /// Whether the cost model lets step d pass between its two side cells. The
  /// step's reversal has the same two.
  bool MayPassCorner(std::size_t index, std::size_t d) const {
    return corner_cutting_ || d % 2 == 0 ||
           (cells_[Neighbour(index, (d + 1) % 8)] != 0 &&
            cells_[Neighbour(index, (d + 7) % 8)] != 0);
  }

 private:
  const std::uint16_t* cells_;
  bool corner_cutting_;
  std::array<std::ptrdiff_t, 8> offset_;
};

}  // namespace terra

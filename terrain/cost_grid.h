#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "terrain/cell.h"
#include "terrain/cost_table.h"
#include "terrain/raster.h"

namespace terra {

/// The costs of a map's cells inside a border of blocked ones: what the
/// searches on all cells read, so that they need no bounds check for a single
/// step.
///
/// Each cell is 16 bits. The low 15 are its cost code, 0 where it is blocked:
/// the cost in exact units (CostTable::units) when holds_units(), else the cost
/// class. The top bit says that the 3x3 block around the cell is of one code,
/// which lets a search expand fewer neighbours.
///
/// Shape: one row above and one below the map; every row starts with kBorder
///        blocked cells and ends with at least one, so that vectors of up to
///        kBorder cells may be read at and beside any cell of the map.
/// Threads: immutable.
class CostGrid {
 public:
  static constexpr int kBorder = 32;
  static constexpr std::uint16_t kCodeMask = 0x7fff;
  static constexpr std::uint16_t kUniformBit = 0x8000;

  CostGrid(const ByteRaster& classes, const CostTable& table);

  /// Cells from one row to the next; a multiple of kBorder.
  int stride() const { return stride_; }
  /// All cells, border included.
  std::size_t size() const { return cells_.size(); }
  const std::uint16_t* data() const { return cells_.data(); }
  std::size_t Index(Cell c) const {
    return static_cast<std::size_t>(c.y + 1) *
               static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(c.x + kBorder);
  }
  /// The cell of an index; outside the map for those of the border.
  Cell CellAt(std::size_t index) const {
    const auto stride = static_cast<std::size_t>(stride_);
    return {static_cast<int>(index % stride) - kBorder,
            static_cast<int>(index / stride) - 1};
  }

  bool holds_units() const { return holds_units_; }

 private:
  void MarkUniformBlocks(int width, int height);

  int stride_;
  bool holds_units_;
  std::vector<std::uint16_t> cells_;
};

}  // namespace terra

#include "terrain/cost_grid.h"

#include <algorithm>
#include <array>

namespace terra {
namespace {

int Stride(Eigen::Index width) {
  const int blocks = static_cast<int>(width) / CostGrid::kBorder + 1;
  return CostGrid::kBorder * (1 + blocks);
}

bool UnitsFitACode(const CostTable& table) {
  return table.scale != 0 &&
         table.units[static_cast<std::size_t>(table.num_classes)] <=
             CostGrid::kCodeMask;
}

}  // namespace

CostGrid::CostGrid(const ByteRaster& classes, const CostTable& table)
    : stride_(Stride(classes.cols())),
      holds_units_(UnitsFitACode(table)),
      cells_(static_cast<std::size_t>(stride_) *
             static_cast<std::size_t>(classes.rows() + 2)) {
  std::array<std::uint16_t, 256> code_of_class{};
  for (std::size_t k = 0; k < code_of_class.size(); ++k) {
    code_of_class[k] =
        static_cast<std::uint16_t>(holds_units_ ? table.units[k] : int(k));
  }
  const auto width = static_cast<int>(classes.cols());
  const auto height = static_cast<int>(classes.rows());
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* from = &classes(y, 0);
    std::transform(from, from + width, &cells_[Index(Cell{0, y})],
                   [&code_of_class](std::uint8_t cost_class) {
                     return code_of_class[cost_class];
                   });
  }
  MarkUniformBlocks(width, height);
}

void CostGrid::MarkUniformBlocks(int width, int height) {
  const auto columns = static_cast<std::size_t>(width) + 2;
  // The rows as they were before they got their marks.
  std::vector<std::uint16_t> above(columns);
  std::vector<std::uint16_t> row(columns);
  // What a cell differs in from the cells above and below it.
  std::vector<std::uint16_t> differs(columns);
  for (int y = 0; y < height; ++y) {
    std::uint16_t* cells = &cells_[Index(Cell{-1, y})];
    const std::uint16_t* below = cells + stride_;
    std::copy_n(cells, columns, row.begin());
    for (std::size_t x = 0; x < columns; ++x) {
      differs[x] =
          static_cast<std::uint16_t>((row[x] ^ above[x]) | (row[x] ^ below[x]));
    }
    for (std::size_t x = 1; x + 1 < columns; ++x) {
      const int difference = (row[x] ^ row[x - 1]) | (row[x] ^ row[x + 1]) |
                             differs[x - 1] | differs[x] | differs[x + 1];
      const bool uniform = difference == 0 && row[x] != 0;
      cells[x] =
          static_cast<std::uint16_t>(row[x] | (uniform ? kUniformBit : 0));
    }
    row.swap(above);
  }
}

}  // namespace terra

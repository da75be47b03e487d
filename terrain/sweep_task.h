#pragma once

#include <cstdint>

namespace terra {

/// One search by sweeping, as plain data: the kernels are compiled for several
/// instruction sets and must share no inline code with the rest.
///
/// Keys are NarrowKeys. Rows and columns are those of the CostGrid, border
/// included, and `keys` has its layout.
struct SweepTask {
  const std::uint16_t* cells;
  std::uint16_t code_mask;
  int stride;
  int rows;          ///< Border included.
  int first_column;  ///< Of the map's cells.
  int last_column;
  bool corner_cutting;

  std::uint32_t straight_per_unit;
  std::uint32_t diagonal_per_unit;
  std::uint32_t limit;  ///< NarrowKeys::kLimit: marks a cell as unreached.

  int start_row;
  int start_column;
  int goal_row;
  int goal_column;

  /// The octile bound of a cell is the larger of along_x + turn_y and
  /// turn_x + along_y: its distances in x and y times a straight step of the
  /// lowest cost (along) and times what a diagonal step costs more (turn).
  const std::uint32_t* along_x = nullptr;  ///< By column.
  const std::uint32_t* turn_x = nullptr;
  const std::uint32_t* along_y = nullptr;  ///< By row.
  const std::uint32_t* turn_y = nullptr;

  /// Room for all cells; nothing need be cleared.
  std::uint32_t* keys = nullptr;
  /// Room for 2 * rows * words_per_row; nothing need be cleared.
  std::uint64_t* pending = nullptr;
  int words_per_row = 0;  ///< At least stride / kFewestLanes / 64 + 1.

  /// Paths at or above it are not wanted; falls to one above the goal's key.
  std::uint32_t bound = 0;
  bool found = false;
  int first_row = 0;  ///< Rows in which `keys` was written.
  int last_row = 0;
  int passes = 0;
  std::int64_t visited = 0;  ///< Cells relaxed, each time counted.
};

inline constexpr int kFewestLanes = 4;

void SweepPortable(SweepTask& task);
#if defined(__x86_64__)
void SweepAvx2(SweepTask& task);
void SweepAvx512(SweepTask& task);
#endif

}  // namespace terra

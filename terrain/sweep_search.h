#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/search_attempt.h"
#include "terrain/search_keys.h"

namespace terra {

struct SweepTask;

/// Instruction sets that the sweep is compiled for.
enum class InstructionSet { kPortable, kAvx2, kAvx512 };

/// Returns the widest one that this processor has.
InstructionSet BestInstructionSet();

/// Search by sweeping: relaxes whole rows of cells, a vector at a time, down
/// and up until no key falls any more. Touches more cells than A* but spends a
/// small part of the time on each.
///
/// Keeps its memory between searches; rows are cleared when first needed.
/// Threads: one search at a time.
/// Source: Bellman 1958; fast sweeping: Zhao 2005 (Mathematics of Computation
///         74). Blocks that are skipped while nothing changes beside them, and
///         the cut by the octile bound, are this project's.
class SweepSearch {
 public:
  /// As BucketSearch::Run. Pre: the map's CostGrid holds units; the bound is at
  /// most NarrowKeys::kLimit, and no octile bound of the map is above that.
  SearchAttempt Run(const TerrainMap& map, const NarrowKeys& keys, Cell start,
                    Cell goal, std::uint32_t bound, InstructionSet set);

  std::size_t bytes() const;

 private:
  SweepTask Prepare(const TerrainMap& map, const NarrowKeys& keys, Cell start,
                    Cell goal);
  void FillOctileTables(const TerrainMap& map, const NarrowKeys& keys,
                        Cell goal, SweepTask& task);

  // Not a vector: its elements would be cleared, which takes as long as a
  // search.
  std::unique_ptr<std::uint32_t[]> keys_;
  std::size_t capacity_ = 0;
  std::vector<std::uint64_t> pending_;  // SweepTask::pending.
  std::vector<std::uint32_t> octile_;   // SweepTask::along_x and the rest.
};

}  // namespace terra

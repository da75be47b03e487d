#include "terrain/sweep_search.h"

#include <algorithm>

#include "terrain/path_extraction.h"
#include "terrain/require.h"
#include "terrain/sweep_task.h"

namespace terra {
namespace {

using Key = NarrowKeys::Key;

void RunKernel(SweepTask& task, InstructionSet set) {
  TERRA_REQUIRE(set <= BestInstructionSet());
  switch (set) {
#if defined(__x86_64__)
    case InstructionSet::kAvx512:
      return SweepAvx512(task);
    case InstructionSet::kAvx2:
      return SweepAvx2(task);
#endif
    default:
      return SweepPortable(task);
  }
}

// Whether some path may have been dropped for lack of a higher bound: a step
// raises a path's total by at most two diagonal steps of the highest cost.
bool MayHaveDropped(const SweepTask& task, const NarrowKeys& keys,
                    const OctileBound<NarrowKeys>& to_goal) {
  Key highest = 0;
  for (int y = task.first_row; y <= task.last_row; ++y) {
    const Key* row = task.keys + std::ptrdiff_t{y} * task.stride;
    for (int x = task.first_column; x <= task.last_column; ++x) {
      if (row[x] < task.limit) {
        highest =
            std::max(highest, row[x] + to_goal(x - CostGrid::kBorder, y - 1));
      }
    }
  }
  return std::uint64_t{highest} + 2 * std::uint64_t{keys.max_diagonal()} >=
         task.bound;
}

// The keys of a sweep, for its path to be read from. Rows that the sweep did
// not come to still hold keys of earlier searches. No cell of a cheapest path
// lacks its key.
class KeysOfPaths {
 public:
  explicit KeysOfPaths(const SweepTask& task)
      : keys_(task.keys),
        first_(RowBegin(task, task.first_row)),
        end_(RowBegin(task, task.last_row + 1)) {}

  Key At(std::size_t index) const {
    return index >= first_ && index < end_ ? keys_[index] : NarrowKeys::kLimit;
  }
  bool IsMarked(std::size_t /*index*/) const { return true; }
  void Mark(std::size_t /*index*/) {}

 private:
  static std::size_t RowBegin(const SweepTask& task, int row) {
    return static_cast<std::size_t>(row) *
           static_cast<std::size_t>(task.stride);
  }

  const Key* keys_;
  std::size_t first_;
  std::size_t end_;
};

}  // namespace

InstructionSet BestInstructionSet() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl")) {
    return InstructionSet::kAvx512;
  }
  if (__builtin_cpu_supports("avx2")) {
    return InstructionSet::kAvx2;
  }
#endif
  return InstructionSet::kPortable;
}

SearchAttempt SweepSearch::Run(const TerrainMap& map, const NarrowKeys& keys,
                               Cell start, Cell goal, Key bound,
                               InstructionSet set) {
  const OctileBound<NarrowKeys> to_goal(keys, goal);
  SearchAttempt attempt;
  if (to_goal(start.x, start.y) >= bound) {
    attempt.beyond_keys = bound == NarrowKeys::kLimit;
    return attempt;
  }
  SweepTask task = Prepare(map, keys, start, goal);
  task.bound = bound;
  RunKernel(task, set);
  attempt.found = task.found;
  attempt.expanded = task.visited;
  attempt.passes = task.passes;
  if (task.found) {
    KeysOfPaths labels(task);
    attempt.cells = PathExtraction(map, keys, start, goal, labels).Run();
  } else if (bound == NarrowKeys::kLimit) {
    attempt.beyond_keys = MayHaveDropped(task, keys, to_goal);
  }
  return attempt;
}

// What the kernel is told of map and ends, with memory for its keys.
SweepTask SweepSearch::Prepare(const TerrainMap& map, const NarrowKeys& keys,
                               Cell start, Cell goal) {
  const CostGrid& grid = map.cost_grid();
  SweepTask task{.cells = grid.data(),
                 .code_mask = CostGrid::kCodeMask,
                 .stride = grid.stride(),
                 .rows = map.height() + 2,
                 .first_column = CostGrid::kBorder,
                 .last_column = CostGrid::kBorder + map.width() - 1,
                 .corner_cutting = map.cost_model().corner_cutting,
                 .straight_per_unit = keys.Straight(1),
                 .diagonal_per_unit = keys.Diagonal(1),
                 .limit = NarrowKeys::kLimit,
                 .start_row = start.y + 1,
                 .start_column = start.x + CostGrid::kBorder,
                 .goal_row = goal.y + 1,
                 .goal_column = goal.x + CostGrid::kBorder};
  if (capacity_ < grid.size()) {
    keys_.reset(new Key[grid.size()]);
    capacity_ = grid.size();
  }
  task.keys = keys_.get();
  task.words_per_row = grid.stride() / kFewestLanes / 64 + 1;
  const auto words = static_cast<std::size_t>(task.rows) * 2 *
                     static_cast<std::size_t>(task.words_per_row);
  pending_.resize(std::max(pending_.size(), words));
  task.pending = pending_.data();
  FillOctileTables(map, keys, goal, task);
  return task;
}

void SweepSearch::FillOctileTables(const TerrainMap& map,
                                   const NarrowKeys& keys, Cell goal,
                                   SweepTask& task) {
  octile_.assign(2 * static_cast<std::size_t>(task.stride + task.rows), 0);
  Key* const along_x = octile_.data();
  Key* const turn_x = along_x + task.stride;
  Key* const along_y = turn_x + task.stride;
  Key* const turn_y = along_y + task.rows;
  const Key along = keys.min_straight();
  const Key turn = keys.min_diagonal() - keys.min_straight();
  for (int x = 0; x < map.width(); ++x) {
    const auto distance = static_cast<Key>(std::abs(x - goal.x));
    along_x[x + CostGrid::kBorder] = distance * along;
    turn_x[x + CostGrid::kBorder] = distance * turn;
  }
  for (int y = 0; y < map.height(); ++y) {
    const auto distance = static_cast<Key>(std::abs(y - goal.y));
    along_y[y + 1] = distance * along;
    turn_y[y + 1] = distance * turn;
  }
  task.along_x = along_x;
  task.turn_x = turn_x;
  task.along_y = along_y;
  task.turn_y = turn_y;
}

std::size_t SweepSearch::bytes() const {
  return capacity_ * sizeof(Key) + pending_.capacity() * sizeof(std::uint64_t) +
         octile_.capacity() * sizeof(Key);
}

}  // namespace terra

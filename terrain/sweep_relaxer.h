// Relaxing one block of kLanes cells: for the sweep's kernels alone
// (sweep_kernel.h says why all is in an unnamed namespace).

#include <cstdint>

#include "terrain/sweep_lanes.h"
#include "terrain/sweep_task.h"

namespace terra {
namespace {

// Lowers the keys of a block, by those of the row beside it and by those of the
// blocks to its west and east. Knows rows, columns and blocks, but not in which
// order they are worked on.
class BlockRelaxer {
 public:
  explicit BlockRelaxer(SweepTask& task)
      : task_(task),
        limit_(Splat(task.limit)),
        num_blocks_((task.last_column - task.first_column) / kLanes + 1) {}

  // Of a row.
  int num_blocks() const { return num_blocks_; }

  std::uint32_t* Row(int y) const {
    return task_.keys + std::int64_t{y} * task_.stride;
  }

  // Marks every cell of a row as unreached. The cells to the east of
  // a row's last block are the west border of the next one, which may never be
  // cleared for itself.
  void ClearRow(int y) {
    for (int x = 0; x < task_.stride + task_.first_column; x += kLanes) {
      Store(Row(y) + x, limit_);
    }
  }

  // Relaxes a block from the row `from`, then hands keys on along the row: east
  // from the block before, west within the block. Returns whether any key fell.
  bool RelaxFromRow(int y, int from, int block) {
    const int x = FirstColumn(block);
    const Lanes units = Units(y, x);
    const Lanes straight = Weights(units, task_.straight_per_unit);
    const Lanes diagonal = Weights(units, task_.diagonal_per_unit);
    Lanes keys = Load<Lanes>(Row(y) + x);
    keys = Min(keys, Load<Lanes>(Row(from) + x) + straight);
    keys = Min(keys, DiagonalPredecessors(y, from, x) + diagonal);
    keys = Spread<East>(keys, straight, Load<Lanes>(Row(y) + x - kLanes));
    keys = Spread<West>(keys, straight, limit_);
    return StoreWanted(y, x, keys);
  }

  // Hands keys on from the block to the east. Returns whether any key fell.
  bool SpreadFromEast(int y, int block) {
    const int x = FirstColumn(block);
    const Lanes straight = Weights(Units(y, x), task_.straight_per_unit);
    return StoreWanted(y, x,
                       Spread<West>(Load<Lanes>(Row(y) + x), straight,
                                    Load<Lanes>(Row(y) + x + kLanes)));
  }

  // Whether the last cell of a block improves the next block's first.
  template <typename Way>
  bool LeadsOn(int y, int block) const {
    const int next = block + Way::kStep;
    if (next < 0 || next >= num_blocks_) {
      return false;
    }
    const int x = FirstColumn(block) + Way::kLast + Way::kStep;
    const std::uint32_t code = Code(y, x);
    const std::uint32_t key =
        Row(y)[x - Way::kStep] + code * task_.straight_per_unit;
    return code != 0 && key < Row(y)[x] &&
           key + OctileBound(y, x) < task_.bound;
  }

 private:
  int FirstColumn(int block) const {
    return task_.first_column + block * kLanes;
  }

  // Stores the keys that fell, but for those on paths that are not wanted: over
  // a cell whose total reaches the bound. Returns whether there were any.
  bool StoreWanted(int y, int x, Lanes keys) {
    task_.visited += kLanes;
    const Lanes old = Load<Lanes>(Row(y) + x);
    const Lanes octile =
        Max(Load<Lanes>(task_.along_x + x) + Splat(task_.turn_y[y]),
            Load<Lanes>(task_.turn_x + x) + Splat(task_.along_y[y]));
    keys = Min(keys, limit_);
    keys = keys + octile < Splat(task_.bound) ? keys : old;
    keys = Min(keys, old);
    if (!AnyBelow(keys, old)) {
      return false;
    }
    Store(Row(y) + x, keys);
    return true;
  }

  // Hands keys on from lane to lane, beginning with the last lane of the block
  // before. The first step shows whether there is anything to do; then each
  // lane takes the best over twice as many lanes, at the sum of the weights
  // between. (That sum is the limit for lanes further back in the block
  // before.)
  template <typename Way>
  Lanes Spread(Lanes keys, Lanes weights, Lanes before) const {
    const Lanes once = Way::template Move<1>(keys, before) + weights;
    if (!AnyBelow(once, keys)) {
      return keys;
    }
    return SpreadFurther<Way, 2>(
        Min(keys, once),
        Min(weights + Way::template Move<1>(weights, limit_), limit_), before);
  }

  template <typename Way, int kBy>
  Lanes SpreadFurther(Lanes keys, Lanes weights, Lanes before) const {
    if constexpr (kBy > kLanes) {
      return keys;
    } else {
      keys = Min(keys, Way::template Move<kBy>(keys, before) + weights);
      if constexpr (kBy < kLanes) {
        weights =
            Min(weights + Way::template Move<kBy>(weights, limit_), limit_);
      }
      return SpreadFurther<Way, 2 * kBy>(keys, weights, before);
    }
  }

  // The smaller key of the two diagonal neighbours in the row `from`.
  Lanes DiagonalPredecessors(int y, int from, int x) const {
    const std::uint32_t* beside = Row(from) + x;
    Lanes west = Load<Lanes>(beside - 1);
    Lanes east = Load<Lanes>(beside + 1);
    if (!task_.corner_cutting) {
      const auto blocked_beside = Units(from, x) == 0;
      west = (blocked_beside | (Units(y, x - 1) == 0)) ? limit_ : west;
      east = (blocked_beside | (Units(y, x + 1) == 0)) ? limit_ : east;
    }
    return Min(west, east);
  }

  std::uint16_t Code(int y, int x) const {
    return task_.cells[std::int64_t{y} * task_.stride + x] & task_.code_mask;
  }
  Lanes Units(int y, int x) const {
    const auto codes =
        Load<Codes>(task_.cells + std::int64_t{y} * task_.stride + x);
    return __builtin_convertvector(codes & task_.code_mask, Lanes);
  }
  // Blocked cells weigh as much as a key can be.
  Lanes Weights(Lanes units, std::uint32_t per_unit) const {
    return units == 0 ? limit_ : units * Splat(per_unit);
  }

  std::uint32_t OctileBound(int y, int x) const {
    const std::uint32_t a = task_.along_x[x] + task_.turn_y[y];
    const std::uint32_t b = task_.turn_x[x] + task_.along_y[y];
    return a < b ? b : a;
  }

  SweepTask& task_;
  Lanes limit_;
  int num_blocks_;
};

}  // namespace
}  // namespace terra

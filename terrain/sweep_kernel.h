// The sweep, compiled once for each instruction set: a source file sets kLanes
// and includes this. Everything is in an unnamed namespace and calls nothing of
// the standard library, so that no code for a newer processor can take the
// place of a function of the same name elsewhere in the program.
//
// Rows are relaxed from the row above, all the way down, then from the row
// below, all the way up, and so on until nothing changes: the fixpoint of
// Bellman's equation. A row is worked on in blocks of kLanes cells, and only
// where the row it is relaxed from has changed since it last was.

#include <cstdint>

#include "terrain/sweep_lanes.h"
#include "terrain/sweep_task.h"

namespace terra {
namespace {

// For sets of a row's blocks, one bit each; no map is wider than 8192 cells
// (TerrainMap::kMaxSide).
constexpr int kMaxWords = 8192 / kLanes / 64 + 1;

class Sweeper {
 public:
  explicit Sweeper(SweepTask& task)
      : task_(task),
        limit_(Splat(task.limit)),
        num_blocks_((task.last_column - task.first_column) / kLanes + 1),
        num_words_((num_blocks_ + 63) / 64) {}

  void Run() {
    task_.first_row = task_.start_row;
    task_.last_row = task_.start_row;
    ClearRow(0);
    ClearRow(task_.start_row);
    Row(task_.start_row)[task_.start_column] = 0;
    // Relaxed from the blocked row 0, only the start's own row is worked on.
    const int block = (task_.start_column - task_.first_column) / kLanes;
    std::uint64_t active[kMaxWords] = {};
    std::uint64_t changed[kMaxWords] = {};
    SetBit(active, block);
    SetBit(changed, block);
    RelaxRow(task_.start_row, 0, active, changed);
    int way = task_.goal_row < task_.start_row ? -1 : 1;
    Pass(way);
    do {
      ++task_.passes;
      way = -way;
    } while (Pass(way));
  }

 private:
  std::uint32_t* Row(int y) const {
    return task_.keys + std::int64_t{y} * task_.stride;
  }

  // The blocks of a row that have changed since the row below (way = 1) or
  // above (way = -1) was relaxed from it.
  std::uint64_t* Pending(int way, int y) const {
    return task_.pending +
           (std::int64_t{y} * 2 + (way > 0 ? 1 : 0)) * task_.words_per_row;
  }

  // The cells to the east of a row's last block are the west border of the next
  // one, which may never be cleared for itself.
  void ClearRow(int y) {
    for (int x = 0; x < task_.stride + task_.first_column; x += kLanes) {
      Store(Row(y) + x, limit_);
    }
    for (int w = 0; w < num_words_; ++w) {
      Pending(1, y)[w] = 0;
      Pending(-1, y)[w] = 0;
    }
  }

  // Rows are cleared when the search first comes to them.
  void TouchRow(int y) {
    if (y < task_.first_row) {
      ClearRow(task_.first_row = y);
    } else if (y > task_.last_row) {
      ClearRow(task_.last_row = y);
    }
  }

  // Relaxes all rows from their neighbours in one direction. Returns whether
  // there was anything to do.
  bool Pass(int way) {
    bool any = false;
    const int end = way > 0 ? task_.rows - 2 : 1;
    for (int y = way > 0 ? task_.first_row : task_.last_row;
         y != end && y >= task_.first_row && y <= task_.last_row; y += way) {
      std::uint64_t active[kMaxWords];
      if (TakePending(way, y, active)) {
        TouchRow(y + way);
        std::uint64_t changed[kMaxWords] = {};
        RelaxRow(y + way, y, active, changed);
        any = true;
      }
    }
    return any;
  }

  // Moves the pending blocks of a row, and those beside them, which a diagonal
  // step reaches, to `active`.
  bool TakePending(int way, int y, std::uint64_t* active) {
    std::uint64_t* pending = Pending(way, y);
    std::uint64_t any = 0;
    std::uint64_t from_west = 0;
    for (int w = 0; w < num_words_; ++w) {
      const std::uint64_t here = pending[w];
      const std::uint64_t east = w + 1 < num_words_ ? pending[w + 1] : 0;
      active[w] = here | here << 1 | from_west | here >> 1 | east << 63;
      from_west = here >> 63;
      any |= here;
    }
    if (any != 0) {
      for (int w = 0; w < num_words_; ++w) {
        pending[w] = 0;
      }
      const int blocks_in_last = (num_blocks_ - 1) % 64 + 1;
      active[num_words_ - 1] &= ~std::uint64_t{0} >> (64 - blocks_in_last);
    }
    return any != 0;
  }

  // Relaxes the active blocks of a row from the row beside it and lets what has
  // changed spread along the row. Adds the blocks in which a key fell to
  // `changed`; uses up `active`.
  void RelaxRow(int y, int from, std::uint64_t* active,
                std::uint64_t* changed) {
    std::uint64_t improved_from_east[kMaxWords] = {};
    RelaxEastward(y, from, active, changed, improved_from_east);
    SpreadWestward(y, improved_from_east, changed);
    for (int w = 0; w < num_words_; ++w) {
      Pending(1, y)[w] |= changed[w];
      Pending(-1, y)[w] |= changed[w];
    }
    if (y == task_.goal_row && Row(y)[task_.goal_column] < task_.bound) {
      task_.bound = Row(y)[task_.goal_column];
      task_.found = true;
    }
  }

  // From west to east, where keys that are handed on activate the next block.
  // Notes the blocks to which keys are to be handed on westward.
  void RelaxEastward(int y, int from, std::uint64_t* active,
                     std::uint64_t* changed,
                     std::uint64_t* improved_from_east) {
    for (int w = 0; w < num_words_; ++w) {
      while (active[w] != 0) {
        const int block = w * 64 + __builtin_ctzll(active[w]);
        active[w] &= active[w] - 1;
        if (RelaxFromRow(y, from, block)) {
          SetBit(changed, block);
        }
        if (!HasBit(changed, block)) {
          continue;
        }
        if (LeadsOn<East>(y, block)) {
          SetBit(active, block + 1);
        }
        if (LeadsOn<West>(y, block)) {
          SetBit(improved_from_east, block - 1);
        }
      }
    }
  }

  // From east to west, over the few blocks that have a use for it.
  void SpreadWestward(int y, std::uint64_t* improved_from_east,
                      std::uint64_t* changed) {
    for (int w = num_words_ - 1; w >= 0; --w) {
      while (improved_from_east[w] != 0) {
        const int bit = 63 - __builtin_clzll(improved_from_east[w]);
        const int block = w * 64 + bit;
        improved_from_east[w] ^= std::uint64_t{1} << bit;
        if (!SpreadFromEast(y, block)) {
          continue;
        }
        SetBit(changed, block);
        if (LeadsOn<West>(y, block)) {
          SetBit(improved_from_east, block - 1);
        }
      }
    }
  }

  static void SetBit(std::uint64_t* words, int block) {
    words[block / 64] |= std::uint64_t{1} << block % 64;
  }
  static bool HasBit(const std::uint64_t* words, int block) {
    return (words[block / 64] >> block % 64 & 1) != 0;
  }

  // Whether the last cell of a block improves the next block's first.
  template <typename Way>
  bool LeadsOn(int y, int block) const {
    const int next = block + Way::kStep;
    if (next < 0 || next >= num_blocks_) {
      return false;
    }
    const int x = task_.first_column + block * kLanes + Way::kLast + Way::kStep;
    const std::uint32_t code = Code(y, x);
    const std::uint32_t key =
        Row(y)[x - Way::kStep] + code * task_.straight_per_unit;
    return code != 0 && key < Row(y)[x] &&
           key + OctileBound(y, x) < task_.bound;
  }

  // Relaxes a block from the row `from`, then hands keys on along the row: east
  // from the block before, west within the block. Returns whether any key fell.
  bool RelaxFromRow(int y, int from, int block) {
    const int x = task_.first_column + block * kLanes;
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
    const int x = task_.first_column + block * kLanes;
    const Lanes straight = Weights(Units(y, x), task_.straight_per_unit);
    return StoreWanted(y, x,
                       Spread<West>(Load<Lanes>(Row(y) + x), straight,
                                    Load<Lanes>(Row(y) + x + kLanes)));
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
      west = blocked_beside | (Units(y, x - 1) == 0) ? limit_ : west;
      east = blocked_beside | (Units(y, x + 1) == 0) ? limit_ : east;
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
  int num_words_;
};

}  // namespace
}  // namespace terra

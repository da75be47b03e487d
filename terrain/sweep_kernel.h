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
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "terrain/sweep_task.h"

namespace terra {
namespace {

using Lanes [[gnu::vector_size(4 * kLanes)]] = std::uint32_t;
using Codes [[gnu::vector_size(2 * kLanes)]] = std::uint16_t;

template <typename Vector, typename Element>
Vector Load(const Element* from) {
  Vector lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

void Store(std::uint32_t* to, Lanes lanes) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}

Lanes Splat(std::uint32_t value) {
  return Lanes{} + value;
}

Lanes Min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
Lanes Max(Lanes a, Lanes b) {
  return a < b ? b : a;
}

// Whether a is below b in any lane.
bool AnyBelow(Lanes a, Lanes b) {
#if defined(__AVX512F__)
  return _mm512_cmplt_epu32_mask(reinterpret_cast<__m512i>(a),
                                 reinterpret_cast<__m512i>(b)) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_epi8(reinterpret_cast<__m256i>(a < b)) != 0;
#elif defined(__SSE2__)
  return _mm_movemask_epi8(reinterpret_cast<__m128i>(a < b)) != 0;
#else
  const auto below = a < b;
  bool any = false;
  for (int i = 0; i < kLanes; ++i) {
    any = any || below[i] != 0;
  }
  return any;
#endif
}

// kLanes lanes of two vectors side by side, from lane kFrom on.
template <int kFrom, int... kLane>
Lanes Window(Lanes west, Lanes east, std::integer_sequence<int, kLane...>) {
  return __builtin_shufflevector(west, east, (kFrom + kLane)...);
}

using AllLanes = std::make_integer_sequence<int, kLanes>;

// The way along a row in which keys are handed on.
struct East {
  // Lane i gets lane i - kBy; the first kBy lanes get those of `entering`.
  template <int kBy>
  static Lanes Move(Lanes lanes, Lanes entering) {
    return Window<kLanes - kBy>(entering, lanes, AllLanes());
  }
  static constexpr int kStep = 1;
  static constexpr int kLast = kLanes - 1;
};
struct West {
  template <int kBy>
  static Lanes Move(Lanes lanes, Lanes entering) {
    return Window<kBy>(lanes, entering, AllLanes());
  }
  static constexpr int kStep = -1;
  static constexpr int kLast = 0;
};

// One bit per block of a row.
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
    active[block / 64] = std::uint64_t{1} << block % 64;
    changed[block / 64] = active[block / 64];
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

  // Relaxes the active blocks of a row from the row beside it, then lets what
  // has changed spread along the row, first east, then west.
  void RelaxRow(int y, int from, std::uint64_t* active,
                std::uint64_t* changed) {
    for (int w = 0; w < num_words_; ++w) {
      for (std::uint64_t bits = active[w]; bits != 0;) {
        const int bit = __builtin_ctzll(bits);
        bits &= bits - 1;
        const int block = w * 64 + bit;
        if (RelaxBlock<true, East>(y, from, block)) {
          changed[w] |= std::uint64_t{1} << bit;
        }
        if ((changed[w] >> bit & 1) == 0 || !LeadsOn<East>(y, block)) continue;
        if (bit < 63) {
          bits |= std::uint64_t{2} << bit;
        } else {
          active[w + 1] |= 1;
        }
      }
    }
    for (int w = num_words_ - 1; w >= 0; --w) {
      for (std::uint64_t bits = changed[w]; bits != 0;) {
        const int bit = 63 - __builtin_clzll(bits);
        bits ^= std::uint64_t{1} << bit;
        const int block = w * 64 + bit;
        RelaxBlock<false, West>(y, from, block);
        if (!LeadsOn<West>(y, block)) continue;
        if (bit > 0) {
          bits |= std::uint64_t{1} << (bit - 1);
          changed[w] |= std::uint64_t{1} << (bit - 1);
        } else {
          changed[w - 1] |= std::uint64_t{1} << 63;
        }
      }
    }
    for (int w = 0; w < num_words_; ++w) {
      Pending(1, y)[w] |= changed[w];
      Pending(-1, y)[w] |= changed[w];
    }
    if (y == task_.goal_row && Row(y)[task_.goal_column] < task_.bound) {
      task_.bound = Row(y)[task_.goal_column];
      task_.found = true;
    }
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

  // Relaxes a block along its row, if kFromRow also from the row `from`.
  // Returns whether any key fell.
  template <bool kFromRow, typename Way>
  bool RelaxBlock(int y, int from, int block) {
    task_.visited += kLanes;
    const int x = task_.first_column + block * kLanes;
    std::uint32_t* row = Row(y) + x;
    const Lanes units = Units(y, x);
    const Lanes straight = Weights(units, task_.straight_per_unit);
    const Lanes old = Load<Lanes>(row);
    Lanes keys = old;
    if constexpr (kFromRow) {
      const std::uint32_t* beside = Row(from) + x;
      const Lanes diagonal = Weights(units, task_.diagonal_per_unit);
      keys = Min(keys, Load<Lanes>(beside) + straight);
      keys = Min(keys, DiagonalPredecessors(y, from, x) + diagonal);
    }
    keys = Spread<Way>(keys, straight, Load<Lanes>(row - Way::kStep * kLanes));
    // A path over a cell whose total reaches the bound is not wanted.
    const Lanes octile = Max(Load<Lanes>(task_.along_x + x) + task_.turn_y[y],
                             Load<Lanes>(task_.turn_x + x) + task_.along_y[y]);
    keys = keys < limit_ ? keys : limit_;
    keys = keys + octile < Splat(task_.bound) ? keys : old;
    keys = Min(keys, old);
    if (!AnyBelow(keys, old)) {
      return false;
    }
    Store(row, keys);
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
    return units == 0 ? limit_ : units * per_unit;
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

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "terrain/map.h"
#include "terrain/segment_steps.h"

namespace terra::planner {

__extension__ using Int128 = __int128;

/// A fraction p / q near sqrt 2, in lowest terms.
struct SqrtTwo {
  std::int64_t p = 1;
  std::int64_t q = 1;
};

/// The first convergent of sqrt 2 whose q exceeds 2^57.
constexpr SqrtTwo kSqrtTwo = [] {
  SqrtTwo r;
  while (r.q <= std::int64_t{1} << 57) {
    r = {r.p + 2 * r.q, r.p + r.q};
  }
  return r;
}();

/// Costs as exact integers, for legends of exact units (CostTable::scale).
///
/// A route costs a + b sqrt 2 units, a and b integers below 2^57 on any map; it
/// is held as a q + b p with p / q a convergent of sqrt 2. Convergents are best
/// approximations, so for |b| < q these numbers are ordered, and equal, exactly
/// as the costs are.
struct ExactArithmetic {
  using Sum = std::int64_t;
  using Cost = Int128;
  /// A sum at or above this has entered a blocked cell: a segment's honest sum
  /// is below 2^13 cells times 10^9 units, and 2^13 blocked cells still fit.
  static constexpr Sum kBlockedSum = Sum{1} << 48;
  static constexpr Cost kUnreached = Int128{1} << 126;

  static Cost Combine(Sum straight, Sum diagonal) {
    return Cost{straight} * kSqrtTwo.q + Cost{diagonal} * kSqrtTwo.p;
  }
  static Sum OfClass(const CostTable& table, std::size_t cost_class) {
    return table.units[cost_class];
  }
};

/// Costs in double precision, for all other legends.
struct DoubleArithmetic {
  using Sum = double;
  using Cost = double;
  static constexpr Sum kBlockedSum = kImpassable;
  static constexpr Cost kUnreached = kImpassable;

  static Cost Combine(Sum straight, Sum diagonal) {
    return straight + diagonal * std::numbers::sqrt2;
  }
  static Sum OfClass(const CostTable& table, std::size_t cost_class) {
    return table.cost[cost_class];
  }
};

/// Sums segments by the rule of WalkRoute without looking at anything twice.
/// Units: Arithmetic::Cost; only order, sums and kUnreached have a meaning.
template <typename Arithmetic>
class StepCosts {
 public:
  using Sum = typename Arithmetic::Sum;
  using Cost = typename Arithmetic::Cost;

  explicit StepCosts(const TerrainMap& map)
      : classes_(map.classes().data()),
        width_(map.width()),
        cut_corners_(map.cost_model().corner_cutting) {
    sum_of_class_.fill(Arithmetic::kBlockedSum);
    const int num_classes = map.costs().num_classes;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(num_classes); ++k) {
      sum_of_class_[k] = Arithmetic::OfClass(map.costs(), k);
    }
    cheapest_ = num_classes == 0 ? Sum{} : sum_of_class_[1];
  }

  /// Returns a lower bound of every route between two cells.
  Cost LowerBound(Cell from, Cell to) const {
    const Lengths n(from, to);
    return Arithmetic::Combine(cheapest_ * static_cast<Sum>(n.major - n.minor),
                               cheapest_ * static_cast<Sum>(n.minor));
  }

  /// Returns the cost of a segment, kUnreached when it is not feasible. Both
  /// ends must be inside the map, the first one passable.
  Cost Segment(Cell from, Cell to) const {
    const Lengths n(from, to);
    if (n.minor == 0 || n.minor == n.major) {
      return Run(from, to);
    }
    return cut_corners_ ? Steps<true>(from, to) : Steps<false>(from, to);
  }

  /// Segment for ends in one row, column or diagonal: no need to decide its
  /// steps.
  Cost Run(Cell from, Cell to) const {
    const Lengths n(from, to);
    const std::ptrdiff_t step = StepX(from, to) + StepY(from, to);
    const std::uint8_t* cell = classes_ + Index(from);
    Sum sum{};
    for (int k = 0; k < n.major; ++k) {
      cell += step;
      sum += sum_of_class_[*cell];
    }
    if (n.minor == 0) {
      return sum < Arithmetic::kBlockedSum ? Arithmetic::Combine(sum, 0)
                                           : Arithmetic::kUnreached;
    }
    const bool open = sum < Arithmetic::kBlockedSum &&
                      (cut_corners_ || SidesPassable(from, to));
    return open ? Arithmetic::Combine(0, sum) : Arithmetic::kUnreached;
  }

 private:
  // Raster steps along the longer and the shorter side of a segment.
  struct Lengths {
    Lengths(Cell from, Cell to) {
      const int dx = std::abs(to.x - from.x);
      const int dy = std::abs(to.y - from.y);
      major = std::max(dx, dy);
      minor = std::min(dx, dy);
    }
    int major;
    int minor;
  };

  static int Sign(int v) { return (v > 0) - (v < 0); }
  std::ptrdiff_t StepX(Cell from, Cell to) const { return Sign(to.x - from.x); }
  std::ptrdiff_t StepY(Cell from, Cell to) const {
    return Sign(to.y - from.y) * std::ptrdiff_t{width_};
  }
  std::ptrdiff_t Index(Cell c) const {
    return c.y * std::ptrdiff_t{width_} + c.x;
  }

  // The cells beside each step of a diagonal.
  bool SidesPassable(Cell from, Cell to) const {
    const std::ptrdiff_t step_x = StepX(from, to);
    const std::ptrdiff_t step_y = StepY(from, to);
    const std::uint8_t* cell = classes_ + Index(from);
    const std::uint8_t* const end = classes_ + Index(to);
    for (; cell != end; cell += step_x + step_y) {
      if (cell[step_x] == 0 || cell[step_y] == 0) {
        return false;
      }
    }
    return true;
  }

  template <bool kCutCorners>
  Cost Steps(Cell from, Cell to) const {
    SegmentSteps steps(from, to, width_);
    const std::uint8_t* cell = classes_ + Index(from);
    Sum straight{};
    Sum diagonal{};
    for (int k = 0; k < steps.count(); ++k) {
      if (steps.NextIsDiagonal()) {
        if (!kCutCorners && (cell[steps.along_longer()] == 0 ||
                             cell[steps.along_shorter()] == 0)) {
          return Arithmetic::kUnreached;
        }
        cell += steps.along_longer() + steps.along_shorter();
        diagonal += sum_of_class_[*cell];
      } else {
        cell += steps.along_longer();
        straight += sum_of_class_[*cell];
      }
    }
    const bool open = straight < Arithmetic::kBlockedSum &&
                      diagonal < Arithmetic::kBlockedSum;
    return open ? Arithmetic::Combine(straight, diagonal)
                : Arithmetic::kUnreached;
  }

  const std::uint8_t* classes_;
  int width_;
  bool cut_corners_;
  Sum cheapest_{};
  std::array<Sum, 256> sum_of_class_;
};

}  // namespace terra::planner

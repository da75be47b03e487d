#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <vector>

#include "terrain/cost_grid.h"
#include "terrain/map.h"

namespace terra {

/// Upper bounds are widened by this, so that one which is the rounded sum of
/// a route's 1e7 steps does not exclude the route itself.
inline constexpr double kAboveRounding = 1 + 1e-9;

/// What searches add up and compare: exact integers in place of costs.
///
/// In the units of an exact legend a path costs a + b sqrt 2 with integers a
/// and b (sums over its straight and its diagonal steps). Its key is the
/// integer a q + b p, where p/q is a convergent of sqrt 2. Keys order paths
/// exactly as their costs do, equal ones included, as long as they are below
/// p q:
///   there b < q, so two keys differ in b by db with |db| < q. The error of
///   replacing q sqrt 2 by p is |db| |q sqrt 2 - p| < |db| / (2 q) < 1/2, so
///   an integer difference of keys of 1 or more has the sign of the costs'
///   difference; and a difference of 0 needs db = 0, p and q having no common
///   divisor, and then the costs are equal.
/// Keys end earlier where sums of two would not fit a signed integer of kBits
/// bits: vectors of keys have those of 32, labels of A* those of 56
/// (search_labels.h).
/// Source: continued fraction of sqrt 2 (Pell numbers).
template <typename KeyType, int kBits, KeyType kQ, KeyType kP>
class IntegerKeys {
 public:
  using Key = KeyType;
  static constexpr Key kLimit = std::min(kQ * kP, (Key{1} << (kBits - 2)) - 1);
  /// Key of what no path has reached: above every sum.
  static constexpr Key kNone = (Key{1} << (kBits - 1)) - 1;

  explicit IntegerKeys(const TerrainMap& map)
      : scale_(map.costs().scale),
        min_units_(static_cast<Key>(map.costs().units[1])),
        max_units_(static_cast<Key>(map.costs().units[static_cast<std::size_t>(
            map.costs().num_classes)])) {}

  /// Key of a step into a cell, by the cell's code in the CostGrid.
  Key Straight(std::uint16_t code) const { return code * kQ; }
  Key Diagonal(std::uint16_t code) const { return code * kP; }

  Key min_straight() const { return min_units_ * kQ; }
  Key min_diagonal() const { return min_units_ * kP; }
  Key max_diagonal() const { return max_units_ * kP; }

  /// Returns a key above that of every path of this cost or less; at most
  /// kLimit, where keys end.
  Key KeyAbove(double cost) const {
    const double key =
        cost * kAboveRounding * scale_ * static_cast<double>(kQ) + 2;
    return key < static_cast<double>(kLimit) ? static_cast<Key>(key) : kLimit;
  }

 private:
  double scale_;
  Key min_units_;
  Key max_units_;
};

/// For sweeps, where half the memory is twice the cells per vector; hold routes
/// of up to 32,089 units (at tenths, cost 3,208).
using NarrowKeys = IntegerKeys<std::uint32_t, 32, 33'461, 47'321>;
/// For A*; hold routes of up to 131,836,322 units (at tenths, cost 13 million).
using WideKeys = IntegerKeys<std::uint64_t, 56, 93'222'358, 131'836'323>;

/// Costs as they are, for legends without exact units and for routes beyond all
/// integer keys. Sums are rounded, so ties may break by rounding.
class DoubleKeys {
 public:
  using Key = double;
  static constexpr Key kLimit = std::numeric_limits<double>::infinity();
  static constexpr Key kNone = kLimit;

  explicit DoubleKeys(const TerrainMap& map) {
    const CostTable& table = map.costs();
    for (int k = 1; k <= table.num_classes; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const auto code = map.cost_grid().holds_units()
                            ? static_cast<std::size_t>(table.units[i])
                            : i;
      if (straight_.size() <= code) {
        straight_.resize(code + 1);
        diagonal_.resize(code + 1);
      }
      straight_[code] = table.cost[i];
      diagonal_[code] = table.cost[i] * std::numbers::sqrt2;
      max_diagonal_ = diagonal_[code];
    }
    min_straight_ = table.min_cost();
  }

  Key Straight(std::uint16_t code) const { return straight_[code]; }
  Key Diagonal(std::uint16_t code) const { return diagonal_[code]; }

  Key min_straight() const { return min_straight_ * kBelow; }
  Key min_diagonal() const { return min_straight() * std::numbers::sqrt2; }
  Key max_diagonal() const { return max_diagonal_; }

  Key KeyAbove(double cost) const { return cost * kAboveRounding; }

 private:
  // Keeps lower bounds below rounded sums.
  static constexpr double kBelow = 1 - 1e-12;

  std::vector<double> straight_;
  std::vector<double> diagonal_;
  double min_straight_;
  double max_diagonal_ = 0;
};

/// Key of the cheapest path that an empty map of the lowest cost would have
/// from a cell to the goal: never above the real one (octile distance).
template <typename Keys>
class OctileBound {
 public:
  using Key = typename Keys::Key;

  OctileBound(const Keys& keys, Cell goal)
      : goal_(goal),
        straight_(keys.min_straight()),
        turn_(keys.min_diagonal() - keys.min_straight()) {}

  Key operator()(int x, int y) const {
    const int dx = std::abs(x - goal_.x);
    const int dy = std::abs(y - goal_.y);
    return static_cast<Key>(std::max(dx, dy)) * straight_ +
           static_cast<Key>(std::min(dx, dy)) * turn_;
  }

 private:
  Cell goal_;
  Key straight_;
  Key turn_;
};

}  // namespace terra

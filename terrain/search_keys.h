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

/// For all other legends, and for routes beyond the keys above: the cost of
/// each kind of step is rounded once to an integer, and these are added up
/// exactly. So a path's key does not depend on the order in which a search adds
/// its steps up, and paths of the same steps have equal keys. Rounding changes
/// the order of costs that differ by less than 1e-12 of them (on maps of 500 x
/// 500; more on larger ones, less on smaller ones).
///
/// The coarser the level, the dearer the routes that keys hold: 64 times as
/// dear from level to level. Level and rounding depend on the map alone.
/// Legends of exact units keep their ties at every level at which q, as in
/// IntegerKeys, is large enough.
class RoundedKeys {
 public:
  using Key = std::uint64_t;
  static constexpr Key kLimit = (Key{1} << 54) - 1;
  static constexpr Key kNone = (Key{1} << 55) - 1;

  /// Pre: 0 <= level < NumLevels(map).
  RoundedKeys(const TerrainMap& map, int level);

  /// At the last level keys hold every path without a loop.
  static int NumLevels(const TerrainMap& map);

  Key Straight(std::uint16_t code) const { return straight_[code]; }
  Key Diagonal(std::uint16_t code) const { return diagonal_[code]; }

  Key min_straight() const { return min_straight_; }
  Key min_diagonal() const { return min_diagonal_; }
  Key max_diagonal() const { return max_diagonal_; }

  /// As IntegerKeys::KeyAbove.
  Key KeyAbove(double cost) const {
    const double key = cost * kAboveRounding * most_per_cost_ + 2;
    return key < static_cast<double>(kLimit) ? static_cast<Key>(key) : kLimit;
  }

 private:
  std::vector<Key> straight_;  // By cost code.
  std::vector<Key> diagonal_;
  Key min_straight_ = 0;
  Key min_diagonal_ = 0;
  Key max_diagonal_ = 0;
  double most_per_cost_ = 0;  // The largest key of a step by its cost.
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

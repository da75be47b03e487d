#pragma once

#include <array>
#include <cstdint>

#include "terrain/legend.h"

namespace terra {

/// The different costs of a legend as small numbers ("classes"), so that a
/// raster of them fits a byte per cell. Class 0 is blocked; classes 1 to
/// num_classes have strictly rising finite costs.
///
/// Where every finite cost is a multiple of 1/scale (scale = 1, 2, 4, 10, 20,
/// 100 or 1000), `units` holds cost x scale as an exact integer, and a route's
/// cost is (a + b sqrt 2) / scale with integers a and b. Otherwise scale is 0.
struct CostTable {
  int num_classes = 0;
  std::array<double, 256> cost{};  ///< cost[0] = kImpassable.
  std::int32_t scale = 0;
  std::array<std::int32_t, 256> units{};        ///< units[0] = 0.
  std::array<std::uint8_t, 256> class_of_id{};  ///< 0 also for unknown ids.

  /// The lowest finite cost; kImpassable where there is none.
  double min_cost() const { return num_classes == 0 ? kImpassable : cost[1]; }
};

CostTable MakeCostTable(const Legend& legend);

}  // namespace terra

#pragma once

#include "benchmark/methods/comparison_refiners.h"

namespace terra::benchmark {

/// What a method must beat before its gains are its own: routes found without
/// looking at the terrain, or without asking what it costs. None of them is an
/// advisor.

/// The straight line from start to goal; kImpassable where it is blocked.
RefineOutput StraightLine(const RefineInput& input);

/// The cheapest of three polished proposals: the straight line, and one detour
/// to each side through the mid-point of start and goal moved sideways by 0.35
/// of their distance.
RefineOutput RefineByBlindDetours(const RefineInput& input);

/// Line-of-sight shortcutting that asks only whether a segment is free: from
/// each kept cell of the baseline's raster to the farthest one in sight. Mostly
/// shorter, often dearer than the baseline.
/// Source: the shortcutting that is common after sampling planners (Geraerts
///         and Overmars 2007, Int. J. of Robotics Research 26).
RefineOutput ShortcutWithoutCost(const RefineInput& input);

}  // namespace terra::benchmark

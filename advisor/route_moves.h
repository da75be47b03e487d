#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// A gain below this is rounding, not a cheaper route.
inline constexpr double kGain = 1e-9;

/// Cost of the straight segment between two cells, kImpassable where it may not
/// be used; SegmentCost, or something stricter.
using SegmentCostFunction = std::function<double(Cell from, Cell to)>;

/// Returns SegmentCost where that is below the limit, else kImpassable: looks
/// at no more of a segment than it takes to know. Sums in doubles, so the last
/// bits may differ from SegmentCost.
/// Pre: both ends inside the map.
double SegmentCostBelow(const TerrainMap& map, Cell from, Cell to,
                        double limit);

/// Returns the waypoints and every `spacing`-th cell of the raster between
/// them. The short segments between these may visit other cells than the long
/// ones did. Successive repetitions are left out, but there are two points at
/// least.
Route Densify(const Route& route, int spacing);

/// Returns the cost from the first point to each, along the straight segments
/// between successive ones.
std::vector<double> PrefixCosts(const Route& points,
                                const SegmentCostFunction& cost);

/// Leaves out waypoints where the straight segment costs no more than what it
/// replaces. The route gets no dearer, and cheaper only by chance: linear work,
/// it gives up on a waypoint after a few dearer segments in a row.
Route ThinWaypoints(const Route& route, const SegmentCostFunction& cost);

/// Moves each inner waypoint to one of its 8 neighbours at falling distances
/// (16 cells, 8, ... 1) while that lowers the cost of its two segments.
///
/// Gains are at least kGain a move and the sweeps are limited, so it ends; it
/// ends early when asked to stop. The route gets no dearer.
void PerturbWaypoints(const TerrainMap& map, Route& route,
                      const std::stop_token& stop);

}  // namespace terra::advisor

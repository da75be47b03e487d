#pragma once

#include "advisor/corridor.h"
#include "advisor/refiners.h"

/// Refiners that the paper compares with, or that its comparison lacks. The
/// robot's advisor has none of them. Like the advisor's they are deterministic
/// and reentrant.
namespace terra::benchmark {

using advisor::RefineInput;
using advisor::RefineOutput;

/// Optimum inside the corridor of Chebyshev `half_width` around the baseline.
RefineOutput RefineByBand(const RefineInput& input,
                          int half_width = advisor::kCorridorHalfWidth);

enum class CampanaForm {
  kLastIterate,      ///< Length objective, exactly as it ends: may be dearer.
  kKeepBest,         ///< Length objective, the cheapest valid iterate.
  kTerrainWeighted,  ///< Segments weighted by their terrain cost, keep-best.
};

/// Gradient-based shortening of the baseline's waypoints, which adds none and
/// slides them along obstacles by linear constraints; see campana.cc.
/// Source: Campana, Lamiraux, Laumond 2016, A gradient-based path optimization
///         method for motion planning (Advanced Robotics 30), as their public
///         implementation has it, for a point robot in the plane.
RefineOutput RefineByCampana(const RefineInput& input, CampanaForm form);

/// APP-style: vertex reduction from both ends, each segment cost-gated, and
/// iterative perturbation, repeated until nothing falls.
/// Source: after the abstract of Li, Cheng 2023 (IEEE RA-L 8(11)), which leaves
///         the thresholds open; not the authors' implementation.
RefineOutput RefineByAppStyle(const RefineInput& input);

}  // namespace terra::benchmark

#pragma once

#include <utility>

#include "terrain/builtin_legends.h"
#include "terrain/map.h"

namespace terra::testing {

inline constexpr Cell kBarStart = {5, 60};
inline constexpr Cell kBarGoal = {155, 60};
/// An answer of a model that is cheaper than any straight way.
inline constexpr const char* kCheaperAnswer =
    "No. [(5, 60), (70, 28), (90, 28), (155, 60)]";

/// Ground with a costly bar between start and goal, open at the top.
inline TerrainMap BarMap() {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(10);
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

}  // namespace terra::testing

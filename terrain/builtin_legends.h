#pragma once

#include <string_view>
#include <vector>

#include "terrain/legend.h"

namespace terra {

/// The legends that need no file.
///   multiterrapath  ids 0..11; paper, Table "Terrain IDs"
///   rugd            the 25 RUGD classes (Wigness et al., IROS 2019) with the
///                   costs of the paper's RUGD table; void is impassable
///   movingai        the characters of MovingAI .map files (Sturtevant 2012):
///                   ground 1, swamp 3, water, trees and out of bounds blocked
///   occupancy       ROS map_server: free 1, occupied and unknown blocked
const Legend& MultiTerraPathLegend();
const Legend& RugdLegend();
const Legend& MovingAiLegend();
const Legend& OccupancyLegend();

/// Ids of the built-in legends that readers write into maps.
inline constexpr int kMovingAiGround = 0;
inline constexpr int kMovingAiSwamp = 1;
inline constexpr int kMovingAiWater = 2;
inline constexpr int kMovingAiTrees = 3;
inline constexpr int kMovingAiOut = 4;
inline constexpr int kOccupancyFree = 0;
inline constexpr int kOccupancyOccupied = 1;
inline constexpr int kOccupancyUnknown = 2;

/// Returns the built-in legend of that name, or nullptr.
const Legend* FindBuiltinLegend(std::string_view name);

/// The names that FindBuiltinLegend knows.
std::vector<std::string_view> BuiltinLegendNames();

}  // namespace terra

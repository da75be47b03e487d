#pragma once

#include <initializer_list>
#include <string_view>

#include "terrain/map.h"

namespace terra::testing {

/// Draws a map in a test: '1' to '9' are terrains of that cost (id = digit),
/// '#' is an obstacle (id 0). MapFromAscii({"111", "9#1", "111"}).
TerrainMap MapFromAscii(std::initializer_list<std::string_view> rows,
                        CostModel model = {});

/// The legend of MapFromAscii.
const Legend& AsciiLegend();

}  // namespace terra::testing

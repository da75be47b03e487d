#pragma once

#include "bus/map_exchange.h"

namespace terra::testing {

/// All tiles of a map in one message. Pre: they fit one.
terra_msg::map_tile_t AllTiles(const TerrainMap& map);

}  // namespace terra::testing

#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bus/messages.h"
#include "terrain/map.h"
#include "terrain/map_tiles.h"
#include "terrain/result.h"

namespace terra::bus {

/// A map that travelled over the bus, with the id that the project knows it by.
struct MapInForce {
  TerrainMap map;
  std::int64_t map_id = 0;
};
using MapPtr = std::shared_ptr<const MapInForce>;

/// What a map header says, checked.
struct MapOutline {
  std::int64_t map_id = 0;
  TileGrid grid;
  Legend legend;
  CostModel model;
  std::vector<std::int64_t> tile_digests;
};

/// Bytes of tile data and their lists in one map_tile_t.
inline constexpr std::size_t kTileMessageBytes = 20'000;

/// Describes a map for the bus; placement and revision stay 0.
terra_msg::map_header_t MakeMapHeader(const TerrainMap& map);

/// Checks a header from the bus: sizes, legend, number of digests, and that
/// map_id is what these fields make.
Result<MapOutline> ReadMapHeader(const terra_msg::map_header_t& header);

/// One zstd frame (RFC 8878) of a tile's ids.
std::vector<std::uint8_t> CompressTile(std::span<const std::uint8_t> ids);

/// Errors: anything that does not unpack to exactly `cells` bytes; never takes
/// more memory than that.
Result<std::vector<std::uint8_t>> UnpackTile(
    std::span<const std::uint8_t> frame, std::size_t cells);

}  // namespace terra::bus

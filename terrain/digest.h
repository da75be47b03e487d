#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/map_tiles.h"

namespace terra {

/// All digests are XXH3-64 with seed 0 (Collet, xxHash) over little-endian
/// bytes, and fit a signed 64-bit message field bit for bit. They tell maps and
/// routes apart; they are no defence against somebody who wants a collision.

/// Digest of any bytes.
std::int64_t BytesDigest(std::span<const std::uint8_t> bytes);

/// Digest of a tile's uncompressed ids, row by row.
std::int64_t TileDigest(std::span<const std::uint8_t> ids);

/// Digests of all tiles of a map, in order of index.
std::vector<std::int64_t> TileDigests(const ByteRaster& ids,
                                      const TileGrid& grid);

/// Identity of a map: over int32 width, height, tile side; int32 number of
/// terrains, then per terrain int32 id and the cost's 64 bits (IEEE 754); int32
/// corner cutting (0 or 1), int32 clearance; then int64 per tile digest. Names
/// and colours do not count. Never 0, which stands for "any map".
std::int64_t MapId(int width, int height, int tile_side, const Legend& legend,
                   const CostModel& model,
                   std::span<const std::int64_t> tile_digests);
std::int64_t MapId(const TerrainMap& map,
                   int tile_side = TileGrid::kDefaultSide);

/// Identity of a baseline: over int64 request_id, int64 map_id, then int32 x
/// and int32 y of each waypoint.
std::int64_t BaselineDigest(std::int64_t request_id, std::int64_t map_id,
                            const Route& waypoints);

}  // namespace terra

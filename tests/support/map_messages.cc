#include "tests/support/map_messages.h"

#include "terrain/digest.h"

namespace terra::testing {

terra_msg::map_tile_t AllTiles(const TerrainMap& map) {
  const TileGrid grid =
      bus::ReadMapHeader(bus::MakeMapHeader(map)).value().grid;
  terra_msg::map_tile_t tiles{};
  tiles.tile_digest = TileDigests(map.ids(), grid);
  tiles.num_tiles = grid.count();
  for (int index = 0; index < grid.count(); ++index) {
    const auto frame = bus::CompressTile(ExtractTile(map.ids(), grid, index));
    tiles.tile_index.push_back(index);
    tiles.tile_size.push_back(static_cast<std::int32_t>(frame.size()));
    tiles.tile_data.insert(tiles.tile_data.end(), frame.begin(), frame.end());
  }
  tiles.num_bytes = static_cast<std::int32_t>(tiles.tile_data.size());
  return tiles;
}

}  // namespace terra::testing

#include "bus/map_exchange.h"

#include <zstd.h>

#include "terrain/digest.h"

namespace terra::bus {
namespace {

constexpr int kCompressionLevel = 3;

Error BadHeader(const std::string& why) {
  return Error{ErrorCode::kInvalid, "map header: " + why};
}

Result<Legend> ReadLegend(const terra_msg::map_header_t& header) {
  std::vector<Terrain> terrains;
  for (std::size_t i = 0; i < header.terrain_id.size(); ++i) {
    terrains.push_back(Terrain{
        header.terrain_id[i], header.terrain_name[i], header.terrain_cost[i],
        FromRgb(static_cast<std::uint32_t>(header.terrain_rgb[i]))});
  }
  return Legend::Create(std::move(terrains));
}

}  // namespace

terra_msg::map_header_t MakeMapHeader(const TerrainMap& map) {
  terra_msg::map_header_t header{};
  header.width = map.width();
  header.height = map.height();
  for (const Terrain& terrain : map.legend().terrains()) {
    header.terrain_id.push_back(static_cast<std::int16_t>(terrain.id));
    header.terrain_cost.push_back(terrain.cost);
    header.terrain_rgb.push_back(
        static_cast<std::int32_t>(ToRgb(terrain.color)));
    header.terrain_name.push_back(terrain.name);
  }
  header.num_terrains = static_cast<std::int32_t>(header.terrain_id.size());
  header.corner_cutting = map.cost_model().corner_cutting ? 1 : 0;
  header.clearance_cells = map.cost_model().clearance_cells;
  const TileGrid grid{map.width(), map.height()};
  header.tile_side = grid.side;
  header.num_tiles = grid.count();
  header.tile_digest = TileDigests(map.ids(), grid);
  header.map_id = MapId(map.width(), map.height(), grid.side, map.legend(),
                        map.cost_model(), header.tile_digest);
  return header;
}

Result<MapOutline> ReadMapHeader(const terra_msg::map_header_t& header) {
  if (header.width < 1 || header.height < 1 ||
      header.width > TerrainMap::kMaxSide ||
      header.height > TerrainMap::kMaxSide) {
    return BadHeader("size " + std::to_string(header.width) + " x " +
                     std::to_string(header.height));
  }
  if (header.tile_side != TileGrid::kDefaultSide) {
    return BadHeader("tile side " + std::to_string(header.tile_side));
  }
  if (header.corner_cutting < 0 || header.corner_cutting > 1 ||
      header.clearance_cells < 0 ||
      header.clearance_cells > TerrainMap::kMaxClearance) {
    return BadHeader("cost model");
  }
  const TileGrid grid{header.width, header.height, header.tile_side};
  if (header.num_tiles != grid.count()) return BadHeader("number of tiles");
  Result<Legend> legend = ReadLegend(header);
  if (!legend) return BadHeader(legend.error().message);
  const CostModel model{header.corner_cutting == 1, header.clearance_cells};
  const std::int64_t id = MapId(header.width, header.height, header.tile_side,
                                *legend, model, header.tile_digest);
  if (id != header.map_id) return BadHeader("map_id does not fit the rest");
  return MapOutline{id, grid, *std::move(legend), model, header.tile_digest};
}

std::vector<std::uint8_t> CompressTile(std::span<const std::uint8_t> ids) {
  std::vector<std::uint8_t> frame(ZSTD_compressBound(ids.size()));
  const std::size_t size = ZSTD_compress(frame.data(), frame.size(), ids.data(),
                                         ids.size(), kCompressionLevel);
  TERRA_REQUIRE(ZSTD_isError(size) == 0);
  frame.resize(size);
  return frame;
}

Result<std::vector<std::uint8_t>> UnpackTile(
    std::span<const std::uint8_t> frame, std::size_t cells) {
  std::vector<std::uint8_t> ids(cells);
  const std::size_t size =
      ZSTD_decompress(ids.data(), ids.size(), frame.data(), frame.size());
  if (ZSTD_isError(size) != 0 || size != cells) {
    return Error{ErrorCode::kInvalid, "a tile that does not unpack"};
  }
  return ids;
}

}  // namespace terra::bus

#include "terrain/digest.h"

#include <xxhash.h>

#include <bit>
#include <cstring>

namespace terra {
namespace {

static_assert(std::endian::native == std::endian::little,
              "digests are defined over little-endian bytes");

class ByteList {
 public:
  template <typename T>
  void Add(T value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }
  std::int64_t Digest() const {
    return static_cast<std::int64_t>(XXH3_64bits(bytes_.data(), bytes_.size()));
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::int64_t BytesDigest(std::span<const std::uint8_t> bytes) {
  return static_cast<std::int64_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

std::int64_t TileDigest(std::span<const std::uint8_t> ids) {
  return BytesDigest(ids);
}

std::vector<std::int64_t> TileDigests(const ByteRaster& ids,
                                      const TileGrid& grid) {
  std::vector<std::int64_t> digests;
  digests.reserve(static_cast<std::size_t>(grid.count()));
  for (int index = 0; index < grid.count(); ++index) {
    digests.push_back(TileDigest(ExtractTile(ids, grid, index)));
  }
  return digests;
}

std::int64_t MapId(int width, int height, int tile_side, const Legend& legend,
                   const CostModel& model,
                   std::span<const std::int64_t> tile_digests) {
  ByteList bytes;
  bytes.Add<std::int32_t>(width);
  bytes.Add<std::int32_t>(height);
  bytes.Add<std::int32_t>(tile_side);
  bytes.Add(static_cast<std::int32_t>(legend.terrains().size()));
  for (const Terrain& terrain : legend.terrains()) {
    bytes.Add<std::int32_t>(terrain.id);
    bytes.Add(std::bit_cast<std::uint64_t>(terrain.cost));
  }
  bytes.Add<std::int32_t>(model.corner_cutting ? 1 : 0);
  bytes.Add<std::int32_t>(model.clearance_cells);
  for (const std::int64_t digest : tile_digests) {
    bytes.Add(digest);
  }
  const std::int64_t id = bytes.Digest();
  return id == 0 ? 1 : id;
}

std::int64_t MapId(const TerrainMap& map, int tile_side) {
  const TileGrid grid{map.width(), map.height(), tile_side};
  return MapId(map.width(), map.height(), tile_side, map.legend(),
               map.cost_model(), TileDigests(map.ids(), grid));
}

std::int64_t BaselineDigest(std::int64_t request_id, std::int64_t map_id,
                            const Route& waypoints) {
  ByteList bytes;
  bytes.Add(request_id);
  bytes.Add(map_id);
  for (const Cell& cell : waypoints) {
    bytes.Add<std::int32_t>(cell.x);
    bytes.Add<std::int32_t>(cell.y);
  }
  return bytes.Digest();
}

}  // namespace terra

#include "terrain/map_tiles.h"

#include <algorithm>
#include <cstring>

#include "terrain/require.h"

namespace terra {

TileGrid::Rect TileGrid::rect(int index) const {
  TERRA_REQUIRE(index >= 0 && index < count());
  const int x = index % columns() * side;
  const int y = index / columns() * side;
  return Rect{x, y, std::min(side, width - x), std::min(side, height - y)};
}

std::vector<std::uint8_t> ExtractTile(const ByteRaster& ids,
                                      const TileGrid& grid, int index) {
  const TileGrid::Rect rect = grid.rect(index);
  std::vector<std::uint8_t> tile(rect.cells());
  const auto row_bytes = static_cast<std::size_t>(rect.width);
  for (int row = 0; row < rect.height; ++row) {
    std::memcpy(tile.data() + static_cast<std::size_t>(row) * row_bytes,
                &ids(rect.y + row, rect.x), row_bytes);
  }
  return tile;
}

void InsertTile(ByteRaster& raster, const TileGrid& grid, int index,
                const std::vector<std::uint8_t>& ids) {
  const TileGrid::Rect rect = grid.rect(index);
  TERRA_REQUIRE(ids.size() == rect.cells());
  const auto row_bytes = static_cast<std::size_t>(rect.width);
  for (int row = 0; row < rect.height; ++row) {
    std::memcpy(&raster(rect.y + row, rect.x),
                ids.data() + static_cast<std::size_t>(row) * row_bytes,
                row_bytes);
  }
}

}  // namespace terra

#pragma once

#include <cstdint>
#include <vector>

#include "terrain/map.h"

namespace terra {

/// The square tiles that a map is sent in. Tile i covers column i % columns and
/// row i / columns of the tile grid; the last ones are cut at the map's border.
struct TileGrid {
  static constexpr int kDefaultSide = 128;

  int width = 0;   ///< Cells.
  int height = 0;  ///< Cells.
  int side = kDefaultSide;

  /// Where a tile lies in the map, in cells.
  struct Rect {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
    std::size_t cells() const {
      return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
  };

  int columns() const { return (width + side - 1) / side; }
  int rows() const { return (height + side - 1) / side; }
  int count() const { return columns() * rows(); }
  /// Pre: 0 <= index < count().
  Rect rect(int index) const;
};

/// Returns the ids of a tile, row by row.
std::vector<std::uint8_t> ExtractTile(const ByteRaster& ids,
                                      const TileGrid& grid, int index);

/// Writes the ids of a tile into its place. Pre: ids.size() == rect.cells().
void InsertTile(ByteRaster& raster, const TileGrid& grid, int index,
                const std::vector<std::uint8_t>& ids);

}  // namespace terra

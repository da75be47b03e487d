#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "terrain/map.h"
#include "terrain/png/png.h"
#include "terrain/result.h"

namespace terra {

/// The largest picture file that is read: 8,192 x 8,192 cells in 24 bits would
/// be 201 MB even without compression.
inline constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20;

/// Decodes a binary PGM (P5) of 8 bits, of a size that a map may have.
/// Errors: name it.
Result<Pixels> DecodePgm(std::string_view bytes, const std::string& name);

/// Encodes pixels as PNG and writes the file.
Status WritePng(const PixelView& pixels, const std::string& path);

/// Copies a grey picture into a raster.
ByteRaster ToRaster(const Pixels& pixels);

/// Errors: a size that no TerrainMap has.
Status CheckMapSize(std::int64_t width, std::int64_t height,
                    const std::string& name);

}  // namespace terra

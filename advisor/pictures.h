#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "advisor/encoded_picture.h"
#include "advisor/prompt.h"
#include "terrain/cell.h"
#include "terrain/legend.h"
#include "terrain/map.h"
#include "terrain/result.h"

namespace terra::advisor {

/// No side of a picture for a model is longer: none of the providers shrinks it
/// then, so that pixels stay cells.
inline constexpr int kMaxPictureSide = 1'568;

/// The baseline is drawn in this blue with a white edge, because terrain 3 of
/// the paper's palette is blue as well.
inline constexpr Color kRouteBlue = FromRgb(0x1F4FE0);

/// 8-bit RGB pixels, row by row from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 x width x height.

  friend bool operator==(const Picture&, const Picture&) = default;
};

/// Chooses the scale: one pixel a cell; with axes two and a margin for numbers,
/// where that fits; an integer reduction where the map does not fit.
PictureFrame ChooseFrame(int width_cells, int height_cells, bool axes);

/// Draws the map in its legend's colours with start (ring, S) and goal (square,
/// G), and a route over the terrain when there is one. A reduced map shows the
/// dearest terrain of each block, obstacles before all.
Picture DrawMap(const TerrainMap& map, const PictureFrame& frame, Cell start,
                Cell goal, const Route* route = nullptr);

/// Draws the two routes of a reference pair side by side, 8 pixels apart.
Picture DrawReferencePair(const TerrainMap& map, const Route& left,
                          const Route& right);

/// Encodes as PNG: 8-bit RGB, no metadata.
EncodedPicture EncodePicture(const Picture& picture);

/// Decodes a PNG of at most kMaxPictureSide x 2 a side.
Result<Picture> DecodePicture(std::string_view png);

/// See EncodedPicture::pixel_hash.
std::string PixelHash(const Picture& picture);

}  // namespace terra::advisor

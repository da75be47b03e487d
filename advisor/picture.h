#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/encoded_picture.h"
#include "terrain/result.h"

namespace terra::advisor {

/// No side of a picture for a model is longer: none of the providers shrinks it
/// then, so that pixels stay cells.
inline constexpr int kMaxPictureSide = 1'568;

/// 8-bit RGB pixels, row by row from the top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 x width x height.

  friend bool operator==(const Picture&, const Picture&) = default;
};

/// Encodes as PNG: 8-bit RGB, no metadata.
EncodedPicture EncodePicture(const Picture& picture);

/// Decodes a 24-bit PNG of at most kMaxPictureSide x 2 a side.
Result<Picture> DecodePicture(std::string_view png);

/// See EncodedPicture::pixel_hash.
std::string PixelHash(const Picture& picture);

}  // namespace terra::advisor

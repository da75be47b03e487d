#pragma once

#include <string>

namespace terra::advisor {

/// A picture ready to be sent. Immutable once made, so threads may share it.
struct EncodedPicture {
  std::string png;  ///< 8-bit RGB, no alpha, no metadata.
  int width_px = 0;
  int height_px = 0;
  /// XXH3-128 in hexadecimal over width, height and the RGB pixels: what the
  /// picture shows, whatever the encoder.
  std::string pixel_hash;
};

}  // namespace terra::advisor

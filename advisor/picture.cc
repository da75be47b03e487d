#include "advisor/picture.h"

#include <utility>

#include "advisor/fingerprint.h"
#include "terrain/png/png.h"

namespace terra::advisor {

EncodedPicture EncodePicture(const Picture& picture) {
  return {EncodePng({picture.rgb.data(), picture.width, picture.height,
                     PixelOrder::kRgb}),
          picture.width, picture.height, PixelHash(picture)};
}

Result<Picture> DecodePicture(std::string_view png) {
  Result<Pixels> pixels = DecodePng(png, 2 * kMaxPictureSide, "picture");
  if (!pixels.ok()) return pixels.error();
  if (pixels->order != PixelOrder::kRgb) {
    return Error{ErrorCode::kUnsupported, "picture: not in colour"};
  }
  return Picture{pixels->width, pixels->height, std::move(pixels->bytes)};
}

std::string PixelHash(const Picture& picture) {
  Fingerprint hash;
  hash.Add(picture.width);
  hash.Add(picture.height);
  hash.AddBytes(picture.rgb.data(), picture.rgb.size());
  return hash.Hex();
}

}  // namespace terra::advisor

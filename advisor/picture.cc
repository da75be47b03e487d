#include "advisor/picture.h"

#include <opencv2/imgcodecs.hpp>

#include "advisor/fingerprint.h"

namespace terra::advisor {

EncodedPicture EncodePicture(const Picture& picture) {
  cv::Mat bgr(picture.height, picture.width, CV_8UC3);
  const std::uint8_t* rgb = picture.rgb.data();
  std::uint8_t* out = bgr.data;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    out[i] = rgb[i + 2];
    out[i + 1] = rgb[i + 1];
    out[i + 2] = rgb[i];
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", bgr, png);
  return {std::string(png.begin(), png.end()), picture.width, picture.height,
          PixelHash(picture)};
}

Result<Picture> DecodePicture(std::string_view png) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t kHeaderBytes = 24;  // Up to the size in IHDR.
  const auto side = [png](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = (value << 8) | static_cast<std::uint8_t>(png[i]);
    }
    return value;
  };
  if (png.size() < kHeaderBytes || !png.starts_with(kSignature)) {
    return Error{ErrorCode::kInvalid, "picture: no PNG"};
  }
  if (side(16) > 2u * kMaxPictureSide || side(20) > 2u * kMaxPictureSide) {
    return Error{ErrorCode::kUnsupported, "picture: too large"};
  }
  // imdecode takes no const pointer, and only reads.
  const cv::Mat bytes(1, static_cast<int>(png.size()), CV_8UC1,
                      const_cast<char*>(png.data()));
  const cv::Mat bgr = cv::imdecode(bytes, cv::IMREAD_COLOR);
  if (bgr.empty()) {
    return Error{ErrorCode::kInvalid, "picture: a damaged PNG"};
  }
  Picture picture{bgr.cols, bgr.rows, {}};
  picture.rgb.resize(bgr.total() * 3);
  std::uint8_t* out = picture.rgb.data();
  for (int y = 0; y < bgr.rows; ++y) {
    const std::uint8_t* row = bgr.ptr(y);
    for (int x = 0; x < bgr.cols; ++x, row += 3, out += 3) {
      out[0] = row[2];
      out[1] = row[1];
      out[2] = row[0];
    }
  }
  return picture;
}

std::string PixelHash(const Picture& picture) {
  Fingerprint hash;
  hash.Add(picture.width);
  hash.Add(picture.height);
  hash.AddBytes(picture.rgb.data(), picture.rgb.size());
  return hash.Hex();
}

}  // namespace terra::advisor

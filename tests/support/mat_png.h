#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "terrain/png/png.h"

namespace terra::testing {

/// Pixels of an OpenCV picture (CV_8UC1, or CV_8UC3 with blue first).
inline PixelView ViewOf(const cv::Mat& image) {
  return {image.data, image.cols, image.rows,
          image.channels() == 1 ? PixelOrder::kGrey : PixelOrder::kBgr};
}

/// Decodes a PNG in colour as OpenCV would, blue first.
inline cv::Mat DecodeMat(std::string_view png) {
  const Pixels pixels = DecodePng(png, 1 << 15, "a picture of a test").value();
  cv::Mat image(pixels.height, pixels.width, CV_8UC3);
  for (int y = 0; y < pixels.height; ++y) {
    const std::uint8_t* rgb = pixels.Row(y);
    for (int x = 0; x < pixels.width; ++x, rgb += 3) {
      image.at<cv::Vec3b>(y, x) = cv::Vec3b(rgb[2], rgb[1], rgb[0]);
    }
  }
  return image;
}

}  // namespace terra::testing

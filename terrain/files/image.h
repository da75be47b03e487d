#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "terrain/map.h"
#include "terrain/result.h"

namespace terra {

/// The largest picture file that is read: 8,192 x 8,192 cells in 24 bits would
/// be 201 MB even without compression.
inline constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20;

/// Returns whether a file begins like a PNG.
bool IsPng(std::string_view bytes);

/// Decodes a PNG without changing a value: CV_8UC1 from 8-bit grey, CV_8UC3
/// (blue, green, red) from 24-bit colour. All else is refused, because OpenCV
/// would convert it silently: palettes, other depths, transparency.
///
/// The chunk list is checked before, so that a torn file, a size above
/// TerrainMap::kMaxSide or a strange header never reaches the decoder.
Result<cv::Mat> DecodePng(std::string_view bytes, const std::string& name);

/// Decodes a binary PGM (P5) of 8 bits. Errors as above.
Result<cv::Mat> DecodePgm(std::string_view bytes, const std::string& name);

/// Encodes CV_8UC1 or CV_8UC3 as PNG and writes the file.
Status WritePng(const cv::Mat& image, const std::string& path);

/// Copies a CV_8UC1 image into a raster.
ByteRaster ToRaster(const cv::Mat& image);

/// Errors: a size that no TerrainMap has.
Status CheckMapSize(std::int64_t width, std::int64_t height,
                    const std::string& name);

}  // namespace terra

#include "terrain/files/image.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "terrain/files/whole_file.h"

namespace terra {
namespace {

constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kChunkOverhead = 12;  // length, type, checksum
constexpr std::size_t kHeaderChunkBytes = 13;

struct PngHeader {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  int bit_depth = 0;
  int color_type = 0;
  bool transparent_color = false;  // a tRNS chunk
};

std::uint32_t ReadBigEndian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8) | static_cast<std::uint8_t>(bytes[at + i]);
  }
  return value;
}

Error Torn(const std::string& name, std::size_t bytes) {
  return Error{ErrorCode::kInvalid,
               name + ": the PNG is truncated or damaged after " +
                   std::to_string(bytes) + " bytes; copy the file again"};
}

// Walks the chunks from IHDR to IEND. Checksums and pixels are the decoder's.
Result<PngHeader> ReadPngHeader(std::string_view bytes,
                                const std::string& name) {
  if (!bytes.starts_with(kPngSignature)) return Torn(name, 0);
  PngHeader header;
  std::size_t at = kPngSignature.size();
  for (bool first = true;; first = false) {
    if (bytes.size() - at < kChunkOverhead) return Torn(name, bytes.size());
    const std::uint32_t length = ReadBigEndian(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (first != (type == "IHDR") || (first && length != kHeaderChunkBytes)) {
      return Torn(name, at);
    }
    if (bytes.size() - at - kChunkOverhead < length) {
      return Torn(name, bytes.size());
    }
    if (first) {
      header.width = ReadBigEndian(bytes, at + 8);
      header.height = ReadBigEndian(bytes, at + 12);
      header.bit_depth = static_cast<std::uint8_t>(bytes[at + 16]);
      header.color_type = static_cast<std::uint8_t>(bytes[at + 17]);
    }
    header.transparent_color |= type == "tRNS";
    if (type == "IEND") return header;
    at += kChunkOverhead + length;
  }
}

// Says what is not taken; empty for 8-bit grey and 24-bit colour.
std::string WhyNotTaken(const PngHeader& header) {
  constexpr int kGrey = 0;
  constexpr int kColor = 2;
  constexpr int kPalette = 3;
  if (header.color_type == kPalette) return "a palette";
  if (header.color_type != kGrey && header.color_type != kColor) {
    return "an alpha channel";
  }
  if (header.transparent_color) return "a transparent colour";
  if (header.bit_depth != 8) {
    return std::to_string(header.bit_depth) + " bits per channel";
  }
  return "";
}

Result<cv::Mat> Decode(std::string_view bytes, const std::string& name,
                       int width, int height) {
  // imdecode only reads; its interface is not const.
  const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1,
                       const_cast<char*>(bytes.data()));
  cv::Mat image;
  try {
    image = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty() || image.cols != width || image.rows != height ||
      (image.type() != CV_8UC1 && image.type() != CV_8UC3)) {
    return Error{ErrorCode::kInvalid,
                 name + ": the picture's data is damaged; copy the file again"};
  }
  return image;
}

// Reads the next number of a PGM header; comments run from # to the line end.
std::int64_t TakePgmNumber(std::string_view bytes, std::size_t& at) {
  const auto is_space = [](char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
  };
  while (at < bytes.size() && (is_space(bytes[at]) || bytes[at] == '#')) {
    if (bytes[at] == '#') {
      at = std::min(bytes.find('\n', at), bytes.size());
    } else {
      ++at;
    }
  }
  std::int64_t value = -1;
  while (at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9') {
    value = std::max<std::int64_t>(value, 0) * 10 + (bytes[at++] - '0');
    if (value > 1'000'000) break;  // larger than anything that is taken
  }
  return value;
}

}  // namespace

bool IsPng(std::string_view bytes) {
  return bytes.starts_with(kPngSignature);
}

Status CheckMapSize(std::int64_t width, std::int64_t height,
                    const std::string& name) {
  if (width >= 1 && height >= 1 && width <= TerrainMap::kMaxSide &&
      height <= TerrainMap::kMaxSide) {
    return Done{};
  }
  return Error{ErrorCode::kUnsupported,
               name + ": " + std::to_string(width) + " x " +
                   std::to_string(height) + " cells; a map has 1 to " +
                   std::to_string(TerrainMap::kMaxSide) +
                   " cells a side: cut it into parts or lower its resolution"};
}

Result<cv::Mat> DecodePng(std::string_view bytes, const std::string& name) {
  const Result<PngHeader> header = ReadPngHeader(bytes, name);
  if (!header.ok()) return header.error();
  const Status size = CheckMapSize(header->width, header->height, name);
  if (!size.ok()) return size.error();
  const std::string refusal = WhyNotTaken(*header);
  if (!refusal.empty()) {
    return Error{ErrorCode::kUnsupported,
                 name + ": this PNG has " + refusal +
                     "; save it as 8-bit greyscale (terrain ids) or 24-bit "
                     "RGB (legend colours)"};
  }
  return Decode(bytes, name, static_cast<int>(header->width),
                static_cast<int>(header->height));
}

Result<cv::Mat> DecodePgm(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("P5")) {
    return Error{ErrorCode::kUnsupported,
                 name + ": neither a binary PGM (P5) nor a PNG"};
  }
  std::size_t at = 2;
  const std::int64_t width = TakePgmNumber(bytes, at);
  const std::int64_t height = TakePgmNumber(bytes, at);
  const std::int64_t max_value = TakePgmNumber(bytes, at);
  const Status size = CheckMapSize(width, height, name);
  if (!size.ok()) return size.error();
  if (max_value != 255) {
    return Error{ErrorCode::kUnsupported,
                 name + ": grey values up to " + std::to_string(max_value) +
                     "; only 8-bit PGM (255) is taken"};
  }
  ++at;  // one white space before the data
  const auto wanted = static_cast<std::size_t>(width * height);
  if (bytes.size() < at || bytes.size() - at < wanted) {
    return Error{ErrorCode::kInvalid,
                 name + ": truncated: " + std::to_string(bytes.size()) +
                     " bytes where " + std::to_string(at + wanted) +
                     " are needed"};
  }
  cv::Mat image(static_cast<int>(height), static_cast<int>(width), CV_8UC1);
  std::memcpy(image.data, bytes.data() + at, wanted);
  return image;
}

Status WritePng(const cv::Mat& image, const std::string& path) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  return WriteWholeFile(
      path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

ByteRaster ToRaster(const cv::Mat& image) {
  ByteRaster raster(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    std::copy_n(image.ptr<std::uint8_t>(y), image.cols,
                raster.data() + static_cast<std::ptrdiff_t>(y) * image.cols);
  }
  return raster;
}

}  // namespace terra

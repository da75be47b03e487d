#include "terrain/files/image.h"

#include <algorithm>
#include <utility>

#include "output/output_file.h"
#include "terrain/require.h"

namespace terra {
namespace {

bool IsPgmSpace(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

// Reads the next number of a PGM header; comments run from # to the line end.
std::int64_t TakePgmNumber(std::string_view bytes, std::size_t& at) {
  while (at < bytes.size() && (IsPgmSpace(bytes[at]) || bytes[at] == '#')) {
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

Result<Pixels> DecodePgm(std::string_view bytes, const std::string& name) {
  const auto is_space_at = [&](std::size_t at) {
    return at < bytes.size() && IsPgmSpace(bytes[at]);
  };
  if (!bytes.starts_with("P5") || !is_space_at(2)) {
    return Error{ErrorCode::kUnsupported,
                 name +
                     ": neither a binary PGM (P5) nor a PNG; convert the "
                     "picture to PNG"};
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
  if (at < bytes.size() && !is_space_at(at)) {
    return Error{
        ErrorCode::kInvalid,
        name + ": the PGM header must end with 255 and one white space"};
  }
  ++at;  // one white space before the data
  const auto wanted = static_cast<std::size_t>(width * height);
  if (bytes.size() < at || bytes.size() - at < wanted) {
    return Error{ErrorCode::kInvalid,
                 name + ": truncated: " + std::to_string(bytes.size()) +
                     " bytes where " + std::to_string(at + wanted) +
                     " are needed"};
  }
  const std::string_view rest = bytes.substr(at + wanted);
  if (!std::all_of(rest.begin(), rest.end(), IsPgmSpace)) {
    return Error{ErrorCode::kInvalid,
                 name + ": " + std::to_string(rest.size()) +
                     " bytes more than the " + std::to_string(width) + " x " +
                     std::to_string(height) +
                     " pixels of its header: one of both is wrong"};
  }
  const std::string_view data = bytes.substr(at, wanted);
  return Pixels{static_cast<int>(width),
                static_cast<int>(height),
                PixelOrder::kGrey,
                {data.begin(), data.end()}};
}

Status WritePng(const PixelView& pixels, const std::string& path) {
  return WriteWholeFile(path, EncodePng(pixels));
}

ByteRaster ToRaster(const Pixels& pixels) {
  TERRA_REQUIRE(pixels.order == PixelOrder::kGrey);
  ByteRaster raster(pixels.height, pixels.width);
  std::copy(pixels.bytes.begin(), pixels.bytes.end(), raster.data());
  return raster;
}

}  // namespace terra

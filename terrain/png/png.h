#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/result.h"

namespace terra {

/// The bytes of a pixel.
enum class PixelOrder {
  kGrey,
  kRgb,
  kBgr,  ///< As OpenCV draws.
};

/// Returns 1 or 3.
int BytesPerPixel(PixelOrder order);

/// Pixels of 8 bits a channel, row by row from the top, without gaps.
struct PixelView {
  const std::uint8_t* bytes = nullptr;
  int width = 0;
  int height = 0;
  PixelOrder order = PixelOrder::kGrey;
};

/// The same with their memory.
struct Pixels {
  int width = 0;
  int height = 0;
  PixelOrder order = PixelOrder::kGrey;
  std::vector<std::uint8_t> bytes;

  /// Where a row begins.
  const std::uint8_t* Row(int y) const {
    return bytes.data() + static_cast<std::size_t>(y) *
                              static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(BytesPerPixel(order));
  }
  PixelView view() const { return {bytes.data(), width, height, order}; }
};

/// Returns whether a file begins like a PNG.
bool IsPng(std::string_view bytes);

/// Decodes a PNG without changing a value: 8-bit grey as kGrey, 24-bit colour
/// as kRgb, whatever gamma or colour profile it claims. All else would have to
/// be converted and is refused: palettes, other depths, transparency. Takes
/// memory for its pixels only where they fit into its bytes.
/// Errors: name it, and say what to do; truncated or damaged anywhere, another
/// kind, more than `max_side` pixels a side.
Result<Pixels> DecodePng(std::string_view png, int max_side,
                         const std::string& name);

/// What the rows of a PNG hold: the file's own samples, a palette replaced by
/// its colours, a transparent colour by an alpha channel, and grey of less than
/// 8 bits spread over 0 to 255.
struct PngForm {
  int width = 0;
  int height = 0;
  int channels = 1;  ///< 1 grey; 2 grey, alpha; 3 RGB; 4 RGB, alpha.
  int bits = 8;      ///< Of a sample: 8, or 16 with the high byte first.

  bool has_alpha() const { return channels % 2 == 0; }
};

/// Takes row `y` of a PNG. The bytes are there only during the call.
using TakePngRow =
    std::function<void(const PngForm& form, int y, const std::uint8_t* row)>;

/// Reads a PNG of any kind row by row from the top, whatever gamma or colour
/// profile it claims. Interlaced ones take the memory of all their pixels.
/// Errors: as DecodePng, but no kind is refused; rows may have been taken.
Result<PngForm> ReadPngRows(std::string_view png, int max_side,
                            const std::string& name, const TakePngRow& take);

enum class PngEffort {
  kFast,   ///< For maps that are read again.
  kSmall,  ///< For pages.
};

/// Encodes without metadata. Pre: pixels that are there.
std::string EncodePng(const PixelView& pixels,
                      PngEffort effort = PngEffort::kFast);

}  // namespace terra

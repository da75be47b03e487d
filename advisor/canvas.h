#pragma once

#include <cstdint>
#include <string_view>

#include "advisor/picture.h"
#include "terrain/legend.h"

namespace terra::advisor {

inline constexpr Color kBlack = {0, 0, 0};
inline constexpr Color kWhite = {255, 255, 255};

/// Draws on a picture; whatever lies outside is left out. Pixels, from the
/// upper left corner. Threads: one.
class Canvas {
 public:
  /// Pre: the picture outlives the canvas.
  explicit Canvas(Picture& picture) : picture_(picture) {}

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }

  /// The three bytes of a pixel; null outside of the picture.
  std::uint8_t* At(int x, int y);

  void Fill(int x, int y, int width, int height, Color color);
  /// Moves a pixel a quarter of the way to mid-grey: seen on every terrain.
  void Fade(int x, int y);
  /// Writes in black, in the letters of pixel_font.h.
  void Text(int x, int y, std::string_view text);

 private:
  Picture& picture_;
};

/// A white picture.
Picture BlankPicture(int width, int height);

}  // namespace terra::advisor

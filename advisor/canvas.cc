#include "advisor/canvas.h"

#include "advisor/pixel_font.h"

namespace terra::advisor {

std::uint8_t* Canvas::At(int x, int y) {
  if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height) {
    return nullptr;
  }
  return picture_.rgb.data() +
         3 * (static_cast<std::size_t>(y) *
                  static_cast<std::size_t>(picture_.width) +
              static_cast<std::size_t>(x));
}

void Canvas::Fill(int x, int y, int width, int height, Color color) {
  for (int row = y; row < y + height; ++row) {
    for (int column = x; column < x + width; ++column) {
      if (std::uint8_t* pixel = At(column, row)) {
        pixel[0] = color.r;
        pixel[1] = color.g;
        pixel[2] = color.b;
      }
    }
  }
}

void Canvas::Fade(int x, int y) {
  if (std::uint8_t* pixel = At(x, y)) {
    for (int i = 0; i < 3; ++i) {
      pixel[i] = static_cast<std::uint8_t>((3 * pixel[i] + 128) / 4);
    }
  }
}

void Canvas::Text(int x, int y, std::string_view text) {
  for (const char c : text) {
    const Glyph& glyph = GlyphOf(c);
    for (int row = 0; row < kGlyphHeight; ++row) {
      for (int column = 0; column < kGlyphWidth; ++column) {
        if (GlyphHas(glyph, column, row)) {
          Fill(x + column, y + row, 1, 1, kBlack);
        }
      }
    }
    x += kGlyphWidth + 1;
  }
}

Picture BlankPicture(int width, int height) {
  Picture picture{width, height, {}};
  picture.rgb.assign(
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3,
      255);
  return picture;
}

}  // namespace terra::advisor

#pragma once

#include <cstddef>
#include <string_view>

namespace terra {

/// One character of a text, as far as its bytes are one.
struct Utf8Character {
  /// Its code point; U+FFFD where the bytes are no UTF-8.
  char32_t code = 0xFFFD;
  /// Bytes to step over; 1 where they are no UTF-8.
  std::size_t bytes = 1;
  bool valid = false;
};

/// Reads the character that begins at `at`. Over-long forms, surrogates and
/// code points above U+10FFFF are not valid.
/// Pre: at < text.size().
/// Source: RFC 3629.
Utf8Character ReadUtf8(std::string_view text, std::size_t at);

/// Is it a control character: C0, DEL or C1? They end strings, steer terminals,
/// or cannot be shown.
constexpr bool IsControl(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0);
}

/// Is every character of the text valid?
bool IsUtf8(std::string_view text);

}  // namespace terra

#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace terra::advisor {

// Characters as every locale has them: what is read must not depend on it.

inline constexpr bool IsSpace(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}
inline constexpr bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}
inline constexpr char Lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
inline constexpr bool IsLetter(char c) {
  return Lower(c) >= 'a' && Lower(c) <= 'z';
}

/// In lower case, for what its standard compares without regard to case:
/// schemes, hosts, header names.
inline std::string Lowered(std::string_view text) {
  std::string lowered(text);
  std::transform(lowered.begin(), lowered.end(), lowered.begin(), Lower);
  return lowered;
}

}  // namespace terra::advisor

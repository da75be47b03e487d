#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace terra {

/// Capitals A to Z made small, whatever the locale; other bytes stay.
inline char LowerAscii(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
inline std::string LowerAscii(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = LowerAscii(c);
  return lower;
}

/// Are they the same but for capitals?
inline bool EqualsInAnyCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char one, char other) {
                      return LowerAscii(one) == LowerAscii(other);
                    });
}

/// Does the name of a file end so, in capitals or not? The extension has its
/// point.
inline bool HasExtension(std::string_view path, std::string_view extension) {
  return path.size() >= extension.size() &&
         EqualsInAnyCase(path.substr(path.size() - extension.size()),
                         extension);
}

}  // namespace terra

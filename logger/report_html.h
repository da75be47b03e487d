#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace terra::logger {

/// Colours mean the same on the whole page.
inline constexpr const char* kRequestColor = "#6b4ea8";
inline constexpr const char* kBaselineColor = "#1f4fe0";
inline constexpr const char* kAdviceColor = "#0f8b8d";
inline constexpr const char* kCandidateColor = "#0a8f2e";
inline constexpr const char* kNoGainColor = "#d08a00";
inline constexpr const char* kBadColor = "#c62f2f";
inline constexpr const char* kNoRouteColor = "#d5dae2";
inline constexpr const char* kMutedColor = "#9aa4b2";

/// Returns a text as it must stand in HTML: markup escaped, bytes that are not
/// printable replaced.
std::string Escape(std::string_view text);

/// Formats as printf does.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

/// "12.34" with so many decimals; "-" for infinite or no number.
std::string Number(double value, int decimals = 2);

/// "0.65 ms", "12.3 s", ...
std::string Duration(double seconds);

/// Explains colours: {as CSS has it, name}; the name is HTML already.
std::string Key(const std::vector<std::pair<std::string, std::string>>& colors);

/// A table; cells are HTML already.
std::string Table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows);

}  // namespace terra::logger

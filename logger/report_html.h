#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace terra::logger {

/// Returns a text as it must stand in HTML: markup escaped, bytes that are not
/// printable replaced.
std::string Escape(std::string_view text);

/// Formats as printf does.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

/// "12.34" with so many decimals; "-" for infinite or no number.
std::string Number(double value, int decimals = 2);

/// "0.65 ms", "12.3 s", ...
std::string Duration(double seconds);

/// RFC 4648, section 4.
std::string Base64(std::span<const std::uint8_t> bytes);

/// A table; cells are HTML already.
std::string Table(const std::vector<std::string>& heads,
                  const std::vector<std::vector<std::string>>& rows);

}  // namespace terra::logger

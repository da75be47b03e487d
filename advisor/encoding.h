#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace terra::advisor {

/// RFC 4648 base64 with padding, without line breaks.
std::string Base64Encode(std::string_view bytes);

/// The reverse; none for anything that Base64Encode would not have written.
std::optional<std::string> Base64Decode(std::string_view text);

/// SHA-256 in 64 hexadecimal digits.
std::string Sha256Hex(std::string_view bytes);

/// Zstandard. Decompress gives none for damaged input and for more than
/// `max_bytes` of content, whatever the header claims.
std::string Compress(std::string_view bytes);
std::optional<std::string> Decompress(std::string_view compressed,
                                      std::size_t max_bytes);

}  // namespace terra::advisor

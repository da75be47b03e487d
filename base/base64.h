#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace terra {

/// RFC 4648 base64 with padding, without line breaks.
std::string Base64Encode(std::string_view bytes);

/// The reverse; none for anything that Base64Encode would not have written.
std::optional<std::string> Base64Decode(std::string_view text);

}  // namespace terra

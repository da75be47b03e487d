#pragma once

#include <string>
#include <string_view>

namespace terra {

/// A text as it may stand in HTML, between tags and in attributes: & < > " and
/// ' escaped, all else as it is.
std::string EscapeHtml(std::string_view text);

}  // namespace terra

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace terra::advisor {

/// A question as a server finds it in a provider's request.
struct WireQuestion {
  std::string provider;  ///< "openai", "gemini", "anthropic", "chat".
  std::string text;      ///< All text parts, joined.
  std::vector<std::string> pngs;
};

/// The other side of WireFormat, for a server that plays a model. Reads a POST
/// in any of the four forms; the path tells which. None for anything else.
/// Any bytes may come.
std::optional<WireQuestion> ReadWireQuestion(std::string_view path,
                                             std::string_view body);

/// Writes a reply in the provider's form that says `text`.
std::string WriteWireReply(std::string_view provider, const std::string& model,
                           const std::string& text);

}  // namespace terra::advisor

#include "advisor/event_stream.h"

#include <algorithm>
#include <array>
#include <string>

#include "advisor/wire_json.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

/// An answer has 8,000 tokens, of which a server sends one an event.
constexpr std::size_t kMostEvents = 100'000;

/// Takes the first line off; it ends with CR, LF or both.
std::string_view TakeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  text.remove_prefix(text.starts_with("\r\n") ? 2 : text.empty() ? 0 : 1);
  return line;
}

}  // namespace

bool IsEventStream(std::string_view body) {
  constexpr std::array<std::string_view, 5> kFields = {
      "data:", "event:", "id:", "retry:", ":"};
  body.remove_prefix(std::min(body.find_first_not_of("\r\n"), body.size()));
  return std::any_of(kFields.begin(), kFields.end(), [&](const auto& field) {
    return body.starts_with(field);
  });
}

std::optional<std::vector<json>> ReadEventStream(std::string_view body) {
  constexpr std::string_view kData = "data:";
  std::vector<json> events;
  std::string data;
  while (!body.empty() || !data.empty()) {
    const bool at_end = body.empty();
    std::string_view line = TakeLine(body);
    if (line.starts_with(kData)) {
      line.remove_prefix(kData.size());
      data.append(line).push_back('\n');  // The space before JSON is no matter.
    } else if (line.empty() || at_end) {
      json event = ParsedOutside(data);
      data.clear();
      if (!event.is_object()) continue;
      if (events.size() == kMostEvents) return std::nullopt;
      events.push_back(std::move(event));
    }
  }
  return events;
}

}  // namespace terra::advisor

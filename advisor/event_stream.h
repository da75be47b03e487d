#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace terra::advisor {

/// Does the body begin as a stream of server-sent events does?
bool IsEventStream(std::string_view body);

/// The JSON objects in the events' data, in order; other data, such as the
/// "[DONE]" at the end, is left out. Nothing where there are more events than
/// any answer needs.
///
/// Form: HTML Living Standard, Server-sent events. Here an event at the end
/// counts without its empty line too. Reads any bytes.
std::optional<std::vector<nlohmann::json>> ReadEventStream(
    std::string_view body);

}  // namespace terra::advisor

#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "bus/messages.h"

namespace terra::cli {

/// A counter of a heartbeat, where it has one of that name.
inline std::optional<std::int64_t> CounterOf(const terra_msg::status_t& status,
                                             std::string_view name) {
  const auto at =
      std::find(status.counter_name.begin(), status.counter_name.end(), name);
  if (at == status.counter_name.end()) return std::nullopt;
  return status.counter_value.at(
      static_cast<std::size_t>(at - status.counter_name.begin()));
}

}  // namespace terra::cli

#pragma once

#include <optional>
#include <string_view>

#include "bus/channels.h"

namespace terra::logger {

/// Returns the project's channel that a name in a log means, under any robot's
/// prefix: TERRA_POSE and R2_TERRA_POSE are poses.
std::optional<bus::Channel> ChannelOf(std::string_view name);

}  // namespace terra::logger

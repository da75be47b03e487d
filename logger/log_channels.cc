#include "logger/log_channels.h"

namespace terra::logger {

std::optional<bus::Channel> ChannelOf(std::string_view name) {
  for (int i = 0; i < bus::kNumChannels; ++i) {
    const auto channel = static_cast<bus::Channel>(i);
    const std::string_view base = bus::BaseName(channel);
    if (name == base ||
        (name.ends_with(base) && name[name.size() - base.size() - 1] == '_')) {
      return channel;
    }
  }
  return std::nullopt;
}

}  // namespace terra::logger

#pragma once

#include <cstdint>
#include <span>

#include "bus/channels.h"

namespace terra::bus {

/// Something that carries encoded messages away: a Bus, or a test's network.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Returns false when the message could not be sent. Never throws.
  virtual bool Publish(Channel channel,
                       std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace terra::bus

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "bus/channels.h"

namespace terra::logger {

/// Counts the messages that came between two recordings, by their senders' seq:
/// a sender whose last message in the earlier recording had seq 7, and whose
/// first one in the later has seq 10, said two messages in between.
///
/// Only senders that are in both recordings are counted (a restarted process
/// has a new session), and only the project's own channels. ADVICE is left out:
/// not all of it is recorded.
///
/// Bounds: kMaxSenders senders; more are not counted.
class SequenceGaps {
 public:
  static constexpr std::size_t kMaxSenders = 1'000;

  explicit SequenceGaps(bus::ChannelNames channels)
      : channels_(std::move(channels)) {}

  /// Takes a message of the earlier recording. Any bytes are safe.
  void Remember(std::string_view channel, std::span<const std::uint8_t> data);

  /// Takes a message of the later recording; returns how many messages of its
  /// sender are missing before it. Any bytes are safe.
  std::int64_t Missing(std::string_view channel,
                       std::span<const std::uint8_t> data);

 private:
  using Sender = std::pair<bus::Channel, std::int64_t>;  // channel, session

  bus::ChannelNames channels_;
  std::map<Sender, std::int64_t> last_seq_;
};

}  // namespace terra::logger

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "bus/channels.h"

namespace terra::bus {

/// A message as it came: bytes that nobody has checked yet.
struct RawMessage {
  Channel channel = Channel::kStatus;
  std::vector<std::uint8_t> bytes;
};

/// The bounded queue between receive threads and the one thread that acts.
///
/// Messages come out in order of arrival. A channel that is full loses its
/// oldest message, since all that travels here is state and the newest counts.
/// Threads: Push and Wake from any thread; Pop and Clear from the acting one.
class Inbox {
 public:
  Inbox();
  ~Inbox();
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  void Push(Channel channel, std::span<const std::uint8_t> bytes);
  std::optional<RawMessage> Pop();

  /// Makes fd() readable without a message.
  void Wake();
  /// Becomes readable with each Push and Wake, until Clear.
  int fd() const { return event_fd_; }
  void Clear();

  /// Messages that a full channel lost.
  std::int64_t dropped() const;

 private:
  static std::size_t Capacity(Channel channel);

  mutable std::mutex mutex_;
  std::deque<RawMessage> messages_;
  std::array<std::size_t, kNumChannels> queued_{};
  std::int64_t dropped_ = 0;
  int event_fd_ = -1;
};

}  // namespace terra::bus

#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace terra::logger {

/// A message as it was heard.
struct HeardEvent {
  std::int64_t time_us = 0;  ///< When, since 1970.
  std::string channel;       ///< Its full name.
  std::vector<std::uint8_t> data;
};

/// The bounded queue between the thread that hears and the one that writes.
///
/// A recorder keeps what it has: when the disk is too slow for the bus, the
/// newest messages are refused, and counted.
/// Threads: any.
class EventQueue {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

  explicit EventQueue(std::size_t max_bytes = kMaxBytes)
      : max_bytes_(max_bytes) {}

  void Push(std::int64_t time_us, std::string_view channel,
            std::span<const std::uint8_t> data);

  /// All events since the last call, in order of arrival, and how many more
  /// were refused.
  struct Batch {
    std::vector<HeardEvent> events;
    std::int64_t refused = 0;
  };
  Batch Take();

  /// Appends a batch of another queue; what does not fit is refused.
  void Push(Batch batch);

 private:
  bool HasRoomFor(std::size_t channel_bytes, std::size_t data_bytes);

  const std::size_t max_bytes_;
  std::mutex mutex_;
  Batch batch_;
  std::size_t bytes_ = 0;
};

}  // namespace terra::logger

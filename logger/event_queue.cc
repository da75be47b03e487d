#include "logger/event_queue.h"

#include <utility>

namespace terra::logger {

void EventQueue::Push(std::int64_t time_us, std::string_view channel,
                      std::span<const std::uint8_t> data) {
  const std::size_t size = sizeof(HeardEvent) + channel.size() + data.size();
  const std::lock_guard lock(mutex_);
  if (size > max_bytes_ - bytes_) {
    ++batch_.refused;
    return;
  }
  bytes_ += size;
  batch_.events.push_back(
      HeardEvent{time_us, std::string(channel), {data.begin(), data.end()}});
}

EventQueue::Batch EventQueue::Take() {
  const std::lock_guard lock(mutex_);
  bytes_ = 0;
  return std::exchange(batch_, Batch{});
}

}  // namespace terra::logger

#include "logger/event_queue.h"

#include <utility>

namespace terra::logger {

// Takes the room that an event needs, or counts it as refused.
bool EventQueue::HasRoomFor(std::size_t channel_bytes, std::size_t data_bytes) {
  const std::size_t size = sizeof(HeardEvent) + channel_bytes + data_bytes;
  if (size > max_bytes_ - bytes_) {
    ++batch_.refused;
    return false;
  }
  bytes_ += size;
  return true;
}

void EventQueue::Push(std::int64_t time_us, std::string_view channel,
                      std::span<const std::uint8_t> data) {
  const std::lock_guard lock(mutex_);
  if (!HasRoomFor(channel.size(), data.size())) return;
  batch_.events.push_back(
      HeardEvent{time_us, std::string(channel), {data.begin(), data.end()}});
}

void EventQueue::Push(Batch batch) {
  const std::lock_guard lock(mutex_);
  batch_.refused += batch.refused;
  for (HeardEvent& event : batch.events) {
    if (HasRoomFor(event.channel.size(), event.data.size())) {
      batch_.events.push_back(std::move(event));
    }
  }
}

EventQueue::Batch EventQueue::Take() {
  const std::lock_guard lock(mutex_);
  bytes_ = 0;
  return std::exchange(batch_, Batch{});
}

}  // namespace terra::logger

#include "bus/inbox.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <sys/eventfd.h>

namespace terra::bus {

Inbox::Inbox() : event_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (event_fd_ < 0) {
    throw std::system_error(errno, std::generic_category(), "eventfd");
  }
}

Inbox::~Inbox() {
  close(event_fd_);
}

std::size_t Inbox::Capacity(Channel channel) {
  // Tiles come in bursts; the rest is repeated state.
  return channel == Channel::kMapTile ? 512 : 128;
}

void Inbox::Push(Channel channel, std::span<const std::uint8_t> bytes) {
  RawMessage message{channel, {bytes.begin(), bytes.end()}};
  {
    const std::lock_guard lock(mutex_);
    std::size_t& queued = queued_[static_cast<std::size_t>(channel)];
    if (queued >= Capacity(channel)) {
      messages_.erase(std::find_if(messages_.begin(), messages_.end(),
                                   [&](const RawMessage& old) {
                                     return old.channel == channel;
                                   }));
      --queued;
      ++dropped_;
    }
    messages_.push_back(std::move(message));
    ++queued;
  }
  Wake();
}

std::optional<RawMessage> Inbox::Pop() {
  const std::lock_guard lock(mutex_);
  if (messages_.empty()) return std::nullopt;
  RawMessage message = std::move(messages_.front());
  messages_.pop_front();
  --queued_[static_cast<std::size_t>(message.channel)];
  return message;
}

void Inbox::Wake() {
  const std::uint64_t one = 1;
  // Fails only when the counter is full, and then fd() is readable anyway.
  [[maybe_unused]] const ssize_t written = write(event_fd_, &one, sizeof one);
}

void Inbox::Clear() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t got = read(event_fd_, &count, sizeof count);
}

std::int64_t Inbox::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace terra::bus

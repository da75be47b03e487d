#include "bus/envelope.h"

#include <algorithm>
#include <chrono>
#include <random>

namespace terra::bus {
namespace {

constexpr std::size_t kRememberedSessions = 64;

}  // namespace

std::int64_t RandomId() {
  std::random_device device;
  std::int64_t id = 0;
  while (id == 0) {
    const std::uint64_t bits = std::uint64_t{device()} << 32 | device();
    id = static_cast<std::int64_t>(bits >> 1);  // not negative: easier to read
  }
  return id;
}

std::int64_t UnixMicroseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

SenderTracker::Sender SenderTracker::Look(std::int64_t session,
                                          std::int64_t seq) {
  if (session == session_) {
    if (seq <= seq_) return Sender::kRepeated;
    // Unsigned, since a hostile seq may be any number.
    lost_ +=
        static_cast<std::uint64_t>(seq) - static_cast<std::uint64_t>(seq_) - 1;
    seq_ = seq;
    return Sender::kCurrent;
  }
  if (std::find(replaced_.begin(), replaced_.end(), session) !=
      replaced_.end()) {
    ++from_replaced_;
    return Sender::kReplaced;
  }
  if (session_ != 0) replaced_.push_back(session_);
  if (replaced_.size() > kRememberedSessions) replaced_.pop_front();
  session_ = session;
  seq_ = seq;
  return Sender::kTookOver;
}

}  // namespace terra::bus

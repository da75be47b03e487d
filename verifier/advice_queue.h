#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>

#include "verifier/gate_messages.h"

namespace terra::verifier {

/// Who sent an advice, as the receiver sees it: for udpm the source address and
/// port of the datagram, else the session of the envelope.
using SenderId = std::uint64_t;

/// How many raster steps the judging of a route walks at most, before anything
/// is known of a map. 0 for a route of too many waypoints, which is not walked.
std::int64_t StepsToJudge(const Route& route);

/// Advice that waits to be judged: fair shares for senders, within a budget.
///
/// Senders take turns, one message a turn; of one sender the message of fewest
/// steps comes first. A message costs its steps, at least `least_steps`; no
/// more is handed out than `steps_per_us` allows on average. So a message of a
/// sender who has no other in the queue waits for at most one message of each
/// sender: with 256 others, 257 x 80,000 steps = 2.1 s.
///
/// Bounds: so many senders, and for each so many messages and bytes. The newest
/// message of a sender always fits: his dearest others make room for it.
/// Time: `now_us` is any steady clock; one that runs back counts as standing.
/// Threads: one.
class AdviceQueue {
 public:
  struct Limits {
    std::size_t senders = 512;
    std::size_t messages_of_sender = 20;
    /// One message of the largest size fits.
    std::size_t bytes_of_sender = 64'000;
    std::int64_t steps_per_us = 10;
    /// What may be handed out at once after a pause; at least the dearest
    /// message.
    std::int64_t burst_steps = 1'000'000;
    /// At most 200 messages a second, as many as the gate remembers for 20 s.
    std::int64_t least_steps = 50'000;
  };
  static constexpr std::int64_t kNever =
      std::numeric_limits<std::int64_t>::max();

  AdviceQueue() : AdviceQueue(Limits{}) {}
  explicit AdviceQueue(const Limits& limits);

  /// Takes a message. One that its sender has in the queue already is left out.
  void Add(SenderId sender, AdviceEvent advice);

  /// The next message to judge; nothing when none waits or the budget is spent.
  std::optional<AdviceEvent> Next(std::int64_t now_us);

  /// When Next has something, as seen at its last call; kNever = none waits.
  std::int64_t next_us() const;

  std::size_t size() const { return size_; }
  std::size_t num_senders() const { return of_sender_.size(); }
  std::size_t bytes() const { return bytes_; }
  /// Messages that found no room, or made room.
  std::int64_t dropped() const { return dropped_; }

 private:
  /// By steps; equal ones in order of arrival.
  using Waiting = std::multimap<std::int64_t, AdviceEvent>;
  struct Sender {
    Waiting waiting;
    std::size_t bytes = 0;
  };

  bool HasRoom(const Sender& sender, std::size_t more_bytes) const;
  AdviceEvent Remove(Sender& sender, Waiting::iterator at);
  void Refill(std::int64_t now_us);
  std::int64_t Charge(std::int64_t steps) const;
  std::int64_t NextCharge() const;

  Limits limits_;
  std::map<SenderId, Sender> of_sender_;
  std::deque<SenderId> turns_;  // each sender of of_sender_ once
  std::size_t size_ = 0;
  std::size_t bytes_ = 0;
  std::int64_t dropped_ = 0;
  std::int64_t steps_left_;
  std::int64_t now_us_ = std::numeric_limits<std::int64_t>::min();
};

}  // namespace terra::verifier

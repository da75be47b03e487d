#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bus/envelope.h"
#include "bus/inbox.h"
#include "bus/messages.h"
#include "bus/time.h"

namespace terra::bus {

/// Named numbers of a heartbeat.
using Counters = std::vector<std::pair<std::string, std::int64_t>>;

/// What a process does, without its clock, its sockets and its threads: takes
/// messages and the time, sends through an Outbox.
///
/// RunProcess drives it with real ones; a test drives it with its own, so that
/// whole sets of nodes run in one thread in virtual time.
/// Threads: one.
class Node {
 public:
  virtual ~Node() = default;

  /// The channels to subscribe.
  const std::vector<Channel>& channels() const { return channels_; }

  /// Decodes a message and hands it to its handler. Malformed ones are counted,
  /// and last_error says of the newest what was wrong with it.
  void Receive(const RawMessage& message, Time now);

  /// Does what is due, and returns when the next thing will be. Called after
  /// every batch of messages and whenever that time has come.
  virtual Time Advance(Time now) = 0;

  /// For the heartbeat: "ready", "waiting for map", ...
  virtual std::string state() const = 0;
  /// What is wrong; empty = nothing. A node with errors of its own says this
  /// one, of a message that it could not decode, where it has none.
  virtual std::string last_error() const { return malformed_error_; }
  virtual void AddCounters(Counters& counters) const;

  /// False when the process hangs in a way that only a restart mends; the
  /// service manager's watchdog is not fed then.
  virtual bool works() const { return true; }

  /// True when the process should end by itself.
  virtual bool done() const { return false; }
  /// Called once when the process ends in order, before exit_code.
  virtual void Finish() {}
  virtual int exit_code() const { return 0; }

 protected:
  Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Counts a message that decodes and makes no sense, and says why.
  void CountMalformed(Channel channel, const std::string& why);

  /// Calls `handle(message, now)` for each well-formed message of type T.
  template <typename T, typename Handler>
  void Listen(Handler handle) {
    constexpr Channel kChannel = MessageTraits<T>::kChannel;
    TERRA_REQUIRE(!handlers_[static_cast<std::size_t>(kChannel)]);
    channels_.push_back(kChannel);
    handlers_[static_cast<std::size_t>(kChannel)] =
        [handle](std::span<const std::uint8_t> bytes, Time now) {
          const Result<T> message = Decode<T>(bytes);
          if (!message) return Status(message.error());
          handle(*message, now);
          return Status(Done{});
        };
  }

 private:
  using RawHandler = std::function<Status(std::span<const std::uint8_t>, Time)>;

  std::vector<Channel> channels_;
  std::array<RawHandler, kNumChannels> handlers_;
  std::int64_t received_ = 0;
  std::int64_t malformed_ = 0;
  std::string malformed_error_;
};

}  // namespace terra::bus

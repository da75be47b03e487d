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

  /// Decodes a message and hands it to its handler. Malformed ones are counted.
  void Receive(const RawMessage& message, Time now);

  /// Does what is due, and returns when the next thing will be. Called after
  /// every batch of messages and whenever that time has come.
  virtual Time Advance(Time now) = 0;

  /// For the heartbeat: "ready", "waiting for map", ...
  virtual std::string state() const = 0;
  virtual std::string last_error() const { return {}; }
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

  /// Calls `handle(message, now)` for each well-formed message of type T.
  template <typename T, typename Handler>
  void Listen(Handler handle) {
    constexpr Channel kChannel = MessageTraits<T>::kChannel;
    TERRA_REQUIRE(!handlers_[static_cast<std::size_t>(kChannel)]);
    channels_.push_back(kChannel);
    handlers_[static_cast<std::size_t>(kChannel)] =
        [handle](std::span<const std::uint8_t> bytes, Time now) {
          const Result<T> message = Decode<T>(bytes);
          if (message) handle(*message, now);
          return message.ok();
        };
  }

 private:
  using RawHandler = std::function<bool(std::span<const std::uint8_t>, Time)>;

  std::vector<Channel> channels_;
  std::array<RawHandler, kNumChannels> handlers_;
  std::int64_t received_ = 0;
  std::int64_t malformed_ = 0;
};

}  // namespace terra::bus

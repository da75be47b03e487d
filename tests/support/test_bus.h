#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/envelope.h"
#include "bus/inbox.h"
#include "bus/messages.h"
#include "bus/time.h"

namespace terra::testing {

/// The buses of one robot, which no other test or robot on this host hears.
///
/// Moves the test into a network namespace of its own where the kernel allows
/// it; else takes three ports that no other test has: deployed bus,
/// advice, journal.
class TestBus {
 public:
  TestBus();
  ~TestBus();
  TestBus(const TestBus&) = delete;
  TestBus& operator=(const TestBus&) = delete;

  const std::string& url() const { return url_; }
  const std::string& advice_url() const { return advice_url_; }
  int port() const { return port_; }
  int advice_port() const { return port_ + 1; }
  bool in_own_namespace() const { return in_own_namespace_; }

 private:
  bool in_own_namespace_ = false;
  int lock_fd_ = -1;
  int port_ = 0;
  std::string url_;
  std::string advice_url_;
};

/// Takes part in a bus from a test: hears every channel, keeps all it heard,
/// and says what the test wants said.
class BusPeer {
 public:
  /// Time for what must happen at all; tests of the exact times run in virtual
  /// time.
  static constexpr std::chrono::seconds kPatience{20};

  explicit BusPeer(const std::string& url, const std::string& robot = "");

  /// Sends, stamped with this peer's session.
  template <typename T>
  void Send(T message) {
    out_.Send(message);
  }
  void SendBytes(bus::Channel channel, std::span<const std::uint8_t> bytes) {
    bus_->Publish(channel, bytes);
  }

  /// Waits for a message that the predicate likes, among those heard since the
  /// start or the last Forget.
  template <typename T>
  std::optional<T> WaitFor(std::function<bool(const T&)> wanted,
                           std::chrono::milliseconds at_most = kPatience) {
    const bus::Time until = bus::Clock::now() + at_most;
    std::size_t next = 0;
    do {
      for (; next < heard_.size(); ++next) {
        const bus::RawMessage& raw = heard_[next];
        if (raw.channel != bus::MessageTraits<T>::kChannel) continue;
        const Result<T> message = bus::Decode<T>(raw.bytes);
        if (message.ok() && wanted(*message)) return *message;
      }
    } while (Hear(until));
    return std::nullopt;
  }

  /// All messages of a type heard since the start or the last Forget.
  template <typename T>
  std::vector<T> Heard() {
    Hear(bus::Clock::now());
    std::vector<T> messages;
    for (const bus::RawMessage& raw : heard_) {
      if (raw.channel != bus::MessageTraits<T>::kChannel) continue;
      const Result<T> message = bus::Decode<T>(raw.bytes);
      if (message.ok()) messages.push_back(*message);
    }
    return messages;
  }

  void Forget();

  std::int64_t session() const { return out_.session(); }

 private:
  // Takes what has come, waiting for at least one message; false at the time.
  bool Hear(bus::Time until);

  bus::Inbox inbox_;
  std::unique_ptr<bus::Bus> bus_;
  bus::Outbox out_;
  std::vector<bus::RawMessage> heard_;
};

}  // namespace terra::testing

#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bus/node.h"
#include "tests/support/random_map.h"

namespace terra::testing {

/// A bus in virtual time: runs whole sets of nodes in one thread, without
/// sockets or sleeps, and loses messages by seed.
class VirtualNetwork {
 public:
  /// Makes a node that sends through the given outbox.
  using Factory = std::function<std::unique_ptr<bus::Node>(bus::Outbox& out)>;

  explicit VirtualNetwork(std::uint64_t seed = 1) : random_(seed) {}

  /// Starts a process (with a new session each time); replaces one of the same
  /// name, as kill -9 and a restart do.
  bus::Node& Start(const std::string& name, const Factory& make);
  void Kill(const std::string& name) { processes_.erase(name); }

  /// One in n messages is lost, per receiver; 0 = none.
  void LoseOneIn(int n) { lose_one_in_ = n; }
  /// So many messages on this channel from now on are lost, for all receivers.
  void LoseNext(bus::Channel channel, int n) { lose_next_[channel] = n; }

  void Run(bus::Duration duration);
  /// Runs until it holds, at most so long; returns whether it did.
  bool RunUntil(const std::function<bool()>& holds, bus::Duration at_most);

  bus::Time now() const { return now_; }

  /// What was published, in order; all of one type, decoded.
  template <typename T>
  std::vector<T> Sent() const {
    std::vector<T> messages;
    for (const bus::RawMessage& raw : sent_) {
      if (raw.channel != bus::MessageTraits<T>::kChannel) continue;
      messages.push_back(bus::Decode<T>(raw.bytes).value());
    }
    return messages;
  }
  const std::vector<bus::RawMessage>& messages() const { return sent_; }
  void ForgetSent() { sent_.clear(); }

  /// Says something as if another process did.
  template <typename T>
  void Inject(const T& message) {
    Publish(nullptr, bus::MessageTraits<T>::kChannel, bus::Encode(message));
  }
  void InjectBytes(bus::Channel channel,
                   const std::vector<std::uint8_t>& bytes) {
    Publish(nullptr, channel, bytes);
  }

 private:
  class Port : public bus::Transport {
   public:
    explicit Port(VirtualNetwork& network) : network_(network) {}
    bool Publish(bus::Channel channel,
                 std::span<const std::uint8_t> bytes) override {
      if (bytes.size() > bus::kMaxMessageBytes) return false;
      network_.Publish(this, channel, {bytes.begin(), bytes.end()});
      return true;
    }

   private:
    VirtualNetwork& network_;
  };
  struct Process {
    explicit Process(VirtualNetwork& network)
        : port(network), out(port, bus::RandomId()) {}
    Port port;
    bus::Outbox out;
    std::unique_ptr<bus::Node> node;
    std::vector<bus::RawMessage> arriving;
    bus::Time next = bus::Time::min();
  };

  void Publish(const Port* from, bus::Channel channel,
               std::vector<std::uint8_t> bytes);
  // Delivers what is under way and lets due nodes act; returns whether
  // anything happened at this time.
  bool Turn();

  Random random_;
  int lose_one_in_ = 0;
  std::map<bus::Channel, int> lose_next_;
  bus::Time now_{std::chrono::hours(1)};
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::vector<bus::RawMessage> sent_;
};

}  // namespace terra::testing

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "bus/map_exchange.h"
#include "bus/messages.h"
#include "chaos/lcm_datagram.h"
#include "terrain/cell.h"

namespace terra::chaos {

/// What a misbehaving advisor knows, and how it says things: the raw material
/// of every fault.
///
/// It knows the map and the cheapest route, so that each lie can be the best
/// advice there is but for one thing; only a check of that thing refuses it.
/// Pure: the same seed and the same events give the same bytes.
/// Threads: one.
class Attacker {
 public:
  struct Identity {
    std::string name;
    std::int64_t session = 0;
    bus::ChannelNames channels;
    std::uint64_t seed = 1;
    bool attacks_deployed_bus = false;
  };
  /// A payload and the channel that it belongs to.
  struct Message {
    bus::Channel channel;
    std::vector<std::uint8_t> payload;
  };

  explicit Attacker(Identity identity);

  /// What is in force now.
  void Learn(const terra_msg::baseline_t& baseline, bus::MapPtr map);
  /// The payload of an ADVICE message of somebody else.
  void Overhear(std::span<const std::uint8_t> payload);
  /// A message of the deployed bus.
  void OverhearDeployed(Message message);
  /// The time that its messages are stamped with.
  void SetTime(std::int64_t unix_us) { unix_us_ = unix_us; }

  bool has_baseline() const { return map_ != nullptr; }
  const terra_msg::baseline_t& baseline() const { return baseline_; }
  const TerrainMap& map() const { return map_->map; }
  /// The cheapest route, by its corners.
  const Route& best() const { return best_; }
  /// Some of the map's blocked cells.
  const std::vector<Cell>& blocked() const { return blocked_; }
  bool attacks_deployed_bus() const { return identity_.attacks_deployed_bus; }
  const std::string& name() const { return identity_.name; }
  const std::string& channel(bus::Channel channel) const {
    return identity_.channels.name(channel);
  }

  /// The best advice for the baseline in force, under the next attempt number.
  /// Pre: has_baseline().
  terra_msg::advice_t Honest();
  /// The same for the baseline before, if there was one.
  std::optional<terra_msg::advice_t> Outdated();
  /// The newest of what was overheard.
  const std::vector<std::vector<std::uint8_t>>& overheard() const {
    return overheard_;
  }
  std::optional<terra_msg::advice_t> LastOverheard() const;

  /// A well-formed message for the bus that is attacked: Honest advice; on the
  /// deployed bus any that was overheard there. Pre: has_baseline().
  Message Good();
  /// A channel of the bus that is attacked.
  const std::string& AttackedChannel();

  /// Bytes of a message, whatever it holds (bus::Encode refuses lies).
  static std::vector<std::uint8_t> Bytes(const terra_msg::advice_t& advice);
  /// As a datagram on the advice channel.
  Datagram Say(const terra_msg::advice_t& advice) { return Say(Bytes(advice)); }
  Datagram Say(std::span<const std::uint8_t> payload) {
    return Say({bus::Channel::kAdvice, {payload.begin(), payload.end()}});
  }
  Datagram Say(const Message& message);

  /// A number for LCM's own header; each message has its own.
  std::uint32_t NextSequence() { return sequence_++; }
  /// Uniform in [low, high], up to a bias of no account.
  int Pick(int low, int high);
  bool OneIn(int n) { return Pick(1, n) == 1; }
  std::vector<std::uint8_t> RandomBytes(int count);

  /// The attempt number that Honest gave last.
  std::int64_t last_attempt() const { return attempt_; }

 private:
  terra_msg::advice_t AdviceFor(const terra_msg::baseline_t& baseline,
                                const Route& route);

  Identity identity_;
  std::mt19937_64 engine_;
  std::int64_t unix_us_ = 0;
  std::int64_t attempt_ = 0;
  std::int64_t seq_ = 0;
  std::uint32_t sequence_ = 0;

  bus::MapPtr map_;
  terra_msg::baseline_t baseline_{};
  Route best_;
  std::vector<Cell> blocked_;
  std::optional<terra_msg::baseline_t> old_baseline_;
  Route old_best_;
  std::vector<std::vector<std::uint8_t>> overheard_;
  std::map<bus::Channel, Message> overheard_deployed_;  // The newest of each.
};

}  // namespace terra::chaos

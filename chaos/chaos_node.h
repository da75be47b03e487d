#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bus/map_receiver.h"
#include "bus/node.h"
#include "chaos/attacker.h"
#include "chaos/faults.h"

namespace terra::chaos {

/// How to misbehave.
struct ChaosOptions {
  std::vector<const Fault*> faults;  ///< One of them a time, by the seed.
  double rate = 10;                  ///< Misdeeds a second.
  bool flood = false;                ///< As many as the machine can.
  double duration_s = 0;             ///< 0 = until asked to stop.
  std::int64_t count = 0;            ///< Misdeeds; 0 = no limit.
};

/// A misbehaving advisor on the bus: listens to the map, BASELINE and VERDICT,
/// and sends what its faults make.
class ChaosNode : public bus::Node {
 public:
  /// `send` puts one datagram on the port that is attacked, false = refused.
  using Send = std::function<bool(const Datagram&)>;

  /// What was sent of a fault, and what the gate said of it.
  struct Tally {
    std::int64_t misdeeds = 0;
    std::int64_t datagrams = 0;
    std::int64_t send_failed = 0;
    std::map<std::int16_t, std::int64_t> verdicts;  ///< By code.
  };

  ChaosNode(ChaosOptions options, Attacker attacker, bus::Outbox& out,
            Send send);

  /// The payload of another advisor's ADVICE.
  void Overhear(std::span<const std::uint8_t> payload);

  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  void AddCounters(bus::Counters& counters) const override;
  bool done() const override { return done_; }
  void Finish() override;
  /// 1 when the gate accepted what it must refuse.
  int exit_code() const override;

  const std::map<std::string_view, Tally>& tallies() const { return tallies_; }
  /// A table for people: fault, misdeeds, datagrams, verdicts.
  std::string Report() const;

 private:
  void Misbehave();
  void OnVerdict(const terra_msg::verdict_t& verdict);
  template <typename T>
  void OverhearDeployed(const T& message);
  template <typename T>
  void ListenOnly();

  ChaosOptions options_;
  Attacker attacker_;
  Send send_;
  bus::MapReceiver map_;
  std::int64_t session_;
  terra_msg::baseline_t baseline_{};
  std::map<std::string_view, Tally> tallies_;
  // The fault that each of the last attempts belonged to.
  std::deque<const Fault*> fault_of_attempt_;
  std::int64_t misdeeds_ = 0;
  bool learned_ = false;
  bool done_ = false;
  bus::Time end_ = bus::kNever;
  bus::Periodic pace_;
};

}  // namespace terra::chaos

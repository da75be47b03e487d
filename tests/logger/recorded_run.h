#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/codec.h"
#include "bus/messages.h"
#include "logger/audit.h"
#include "terrain/map.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"
#include "tests/support/virtual_network.h"

namespace terra::logger {

using Messages = std::vector<bus::RawMessage>;

/// A run of the deployed path in virtual time, with the test as requester,
/// advisor and robot; keeps what was said.
class RecordedRun {
 public:
  static constexpr Cell kStart = {5, 60};
  static constexpr Cell kGoal = {155, 60};

  explicit RecordedRun(double margin = 0);

  void StartMap();
  void StartPlanner();
  void StartGate();

  /// Ground with a bar of a terrain between start and goal, open at the top and
  /// where it has a hole.
  static TerrainMap BarMap(int bar_id, int hole_y = -1);
  void SaveMap(const TerrainMap& map);

  void Ask(std::int64_t request_id, bool cancel = false);
  /// Advice for a baseline, from the start on or from a cell of a deployed
  /// route on.
  terra_msg::advice_t AdviceFor(const terra_msg::baseline_t& baseline,
                                const Route& route);
  void Advise(const terra_msg::baseline_t& baseline, const Route& route,
              std::int8_t kind = terra_msg::advice_t::KIND_PROPOSE);
  void AdviseFrom(const terra_msg::deployed_t& deployed, int index);
  void DriveTo(const terra_msg::deployed_t& deployed, int index);

  /// Says something, and waits for what comes of it.
  template <typename T>
  void Inject(T message) {
    Say(std::move(message));
    network_.Run(std::chrono::milliseconds(300));
  }
  /// Says something as the next of many.
  template <typename T>
  void Say(T message) {
    message.seq = ++said_;
    network_.Inject(message);
  }
  void SayAgain(const bus::RawMessage& message) {
    network_.InjectBytes(message.channel, message.bytes);
  }
  void Run(bus::Duration duration) { network_.Run(duration); }

  /// The newest, if any.
  std::optional<terra_msg::baseline_t> Baseline() const;
  std::optional<terra_msg::deployed_t> Deployed() const;
  const Messages& messages() const { return network_.messages(); }

 private:
  const double margin_;
  testing::TempFolder folder_;
  testing::VirtualNetwork network_;
  int saves_ = 0;
  std::int64_t said_ = 0;
};

/// Requests, advice of every kind, a moving robot, map updates, restarts.
Messages EventfulRun();

/// The same by chance.
Messages RandomRun(std::uint64_t seed);

/// How many decisions the gates made.
std::int64_t DecisionsIn(const Messages& messages);

/// An event log without seals, as LCM's own logger writes it.
std::vector<std::uint8_t> LogOf(const Messages& messages);
Audit AuditOf(const Messages& messages);
/// The same of the log that a recorder of ours writes, with its seals.
Audit AuditOfRecording(const Messages& messages);

/// The findings, to be read when a test fails.
std::string Text(const Audit& audit);

/// All messages of one type.
template <typename T>
std::vector<T> Said(const Messages& messages) {
  std::vector<T> said;
  for (const bus::RawMessage& message : messages) {
    if (message.channel != bus::MessageTraits<T>::kChannel) continue;
    said.push_back(bus::Decode<T>(message.bytes).value());
  }
  return said;
}

}  // namespace terra::logger

#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "bus/map_exchange.h"
#include "logger/event_queue.h"

namespace terra::logger {

/// The messages that make up the state in force, as they came. Each part of a
/// log begins with them, so that it can be audited without the parts before.
///
/// Keeps the newest CONFIG of each process; the map of the newest MAP_HEADER,
/// with the tiles that it lists, and the maps that DEPLOYED and the gate's
/// journal name if those are others; the newest PLAN_REQUEST and POSE; the
/// newest baselines (what is deployed may be an older one) and advice (its
/// verdict may come in the next part); and of each gate the newest step of its
/// journal, the DEPLOYED that was in force after it, and the decisions that
/// came since, whose step comes in this part. Of a gate without a journal the
/// newest DEPLOYED and VERDICT.
///
/// Bounds: three maps' compressed tiles, kMaxProcesses configurations,
///         kMaxBaselines, kMaxAdvice, kMaxGates, kMaxDecided of each. Malformed
///         messages change nothing.
/// Threads: one.
class StateSnapshot {
 public:
  static constexpr std::size_t kMaxProcesses = 64;
  static constexpr std::size_t kMaxAdvice = 64;
  static constexpr std::size_t kMaxBaselines = 8;
  static constexpr std::size_t kMaxGates = 4;
  static constexpr std::size_t kMaxDecided = 32;

  void Take(bus::Channel channel, const HeardEvent& event);

  /// Calls `visit` for each message, in the order of the list above.
  void Visit(const std::function<void(const HeardEvent&)>& visit) const;

 private:
  using Kept = std::shared_ptr<const HeardEvent>;
  struct KeptMap {
    Kept header;
    bus::MapOutline outline;
    std::vector<Kept> tiles;  // One message may carry several.
  };
  struct KeptBaseline {
    std::int64_t digest = 0;
    std::int64_t planner = 0;  // Its session: two may find the same route.
    Kept message;
  };
  struct KeptDecision {
    Kept message;
    bool is_deployed = false;
  };
  // One session of the gate; it deploys nothing before it is asked for a route.
  struct KeptGate {
    std::int64_t session = 0;
    Kept step;
    std::int64_t last_of_step = 0;  // The last decision of that step.
    std::map<std::int64_t, KeptDecision> decided;  // By number.
  };

  void TakeHeader(const HeardEvent& event);
  void TakeTiles(const HeardEvent& event);
  void TakeTile(const Kept& message, std::int32_t index,
                std::span<const std::uint8_t> frame);
  void TakeConfig(const HeardEvent& event);
  void TakeBaseline(const HeardEvent& event);
  void TakeAdvice(const HeardEvent& event);
  void TakeDeployed(const HeardEvent& event);
  void TakeVerdict(const HeardEvent& event);
  void TakeStep(const HeardEvent& event);
  static void Keep(KeptGate& gate, std::int64_t decision,
                   const KeptDecision& decided);
  static void DropOldDecisions(KeptGate& gate);
  KeptGate& GateOf(std::int64_t session);
  bool IsNamed(const KeptMap& map) const;
  void DropOldMaps();
  template <typename T>
  void TakeNewest(Kept& kept, const HeardEvent& event);

  std::map<std::string, Kept> configs_;
  std::optional<KeptMap> map_;
  std::deque<KeptMap> old_maps_;  // That a gate still names.
  Kept request_;
  // Different ones, the newest last.
  std::deque<KeptBaseline> baselines_;
  std::deque<Kept> advice_;
  Kept pose_;
  std::deque<KeptGate> gates_;  // The one that began last is last.
  std::int64_t deployed_map_id_ = 0;
  std::int64_t journal_map_id_ = 0;
};

}  // namespace terra::logger

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "bus/map_exchange.h"
#include "logger/event_queue.h"

namespace terra::logger {

/// The messages that make up the state in force, as they came. Each part of a
/// log begins with them, so that it can be audited without the parts before.
///
/// Keeps the newest CONFIG of each process, MAP_HEADER and the tiles that it
/// lists, the newest PLAN_REQUEST, POSE and DEPLOYED, the newest baselines
/// (what is deployed may be an older one), and the advice on the current one
/// (its verdict may come in the next part).
///
/// Bounds: a map's compressed tiles, kMaxProcesses configurations, kMaxAdvice
///         advices. Malformed messages change nothing.
/// Threads: one.
class StateSnapshot {
 public:
  static constexpr std::size_t kMaxProcesses = 64;
  static constexpr std::size_t kMaxAdvice = 64;
  static constexpr std::size_t kMaxBaselines = 8;

  void Take(bus::Channel channel, const HeardEvent& event);

  /// Calls `visit` for each message, in the order of the list above.
  void Visit(const std::function<void(const HeardEvent&)>& visit) const;

 private:
  using Kept = std::shared_ptr<const HeardEvent>;

  void TakeHeader(const HeardEvent& event);
  void TakeTiles(const HeardEvent& event);
  void TakeConfig(const HeardEvent& event);
  void TakeBaseline(const HeardEvent& event);
  void TakeAdvice(const HeardEvent& event);
  template <typename T>
  void TakeNewest(Kept& kept, const HeardEvent& event);

  std::map<std::string, Kept> configs_;
  Kept header_;
  std::optional<bus::MapOutline> outline_;
  std::vector<Kept> tiles_;  // One message may carry several.
  Kept request_;
  std::deque<Kept> baselines_;  // Of different digests, the newest last.
  std::int64_t baseline_digest_ = 0;
  std::map<std::array<std::int64_t, 3>, Kept> advice_;
  Kept pose_;
  Kept deployed_;
};

}  // namespace terra::logger

#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "logger/log_contents.h"

namespace terra::logger {

/// What the decisions of one session tell about what was in force before them.
///
/// The gate takes up a baseline that is not cheaper, or a map while nothing is
/// asked of it, without a decision; a later decision names it.
/// Bounds: looks at the next kHorizon decisions only.
class LaterDecisions {
 public:
  using Decisions = std::map<std::int64_t, Logged<LogContents::Decided>>;
  static constexpr int kHorizon = 10'000;

  /// The decisions must outlive this.
  explicit LaterDecisions(const Decisions& decisions) : decisions_(decisions) {}

  /// The planner's session with the baseline that is named from a decision on;
  /// 0 when none names it.
  std::int64_t PlannerOf(std::int64_t digest, std::int64_t decision) const;

  /// The next baseline named after a decision, but not this one; 0 = none.
  std::int64_t BaselineAfter(std::int64_t digest, std::int64_t decision) const;
  /// The next map on which is decided after a decision, but not this one.
  std::int64_t MapAfter(std::int64_t map_id, std::int64_t decision) const;

  /// What verdicts after a decision call stale, so that it was in force before,
  /// unless it came into force later.
  struct Replaced {
    std::set<std::int64_t> requests;
    std::set<std::int64_t> maps;
    std::set<std::int64_t> baselines;
  };
  Replaced ReplacedBefore(std::int64_t decision) const;

 private:
  template <typename Visit>
  void ForEachFrom(std::int64_t decision, Visit visit) const;

  const Decisions& decisions_;
};

/// Returns whether a verdict speaks of what is no longer in force.
bool IsStale(const terra_msg::verdict_t& verdict);

}  // namespace terra::logger

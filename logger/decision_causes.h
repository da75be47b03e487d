#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "logger/later_decisions.h"
#include "logger/log_contents.h"
#include "logger/replayed_gate.h"

namespace terra::logger {

/// What a gate may have heard, so that it decided as it says: each way is to be
/// tried, in this order.
struct Ways {
  std::vector<GateEvents> all;
  std::string missing;  ///< What the log does not hold for a further way.
  /// To a verdict on advice: how many messages the log holds under the name of
  /// what was judged. An honest advisor says one thing under each name.
  std::size_t num_advice = 1;
};

/// Finds, in a log, the inputs that the decisions of one session name.
///
/// A decision names its inputs, but not what came into force before it without
/// a decision; where that matters there is more than one way.
/// Threads: one.
class DecisionCauses {
 public:
  /// Both must outlive this.
  DecisionCauses(LogContents& contents, std::int64_t session,
                 const LaterDecisions& later)
      : contents_(contents), session_(session), later_(later) {}

  /// The gate's state begins with a DEPLOYED at this event; 0 = at its start.
  void BeginAt(std::int64_t index) { began_at_ = index; }

  /// Ways from the gate's present state to the next decision. The log's
  /// route_seqs are `route_seq_offset` ahead of this gate's.
  Ways WaysTo(const Logged<LogContents::Decided>& decision,
              const ReplayedGate& gate, std::int64_t route_seq_offset);

  /// All poses that the gate of the last WaysTo may have heard besides, before
  /// that decision.
  GateEvents AllPoses() const;

 private:
  /// Events of a part of a way; nothing when the log does not hold them.
  using Step = std::optional<GateEvents>;

  void WaysTo(const terra_msg::deployed_t& deployed, Ways& ways);
  void WaysToCancelled(const terra_msg::deployed_t& deployed, Ways& ways);
  void WaysToNewMap(const terra_msg::deployed_t& deployed, Ways& ways);
  void WaysTo(const terra_msg::verdict_t& verdict, Ways& ways);
  void WaysToBaselineVerdict(const terra_msg::verdict_t& verdict, Ways& ways);
  void WaysToStale(const terra_msg::verdict_t& verdict, const Step& advice,
                   Ways& ways);
  void WaysToStaleBaseline(const terra_msg::verdict_t& verdict,
                           const Step& advice, Ways& ways);
  void WaysToJudged(const terra_msg::verdict_t& verdict, const Step& advice,
                    Ways& ways);

  Step Map(std::int64_t map_id, Ways& ways);
  std::vector<std::int64_t> MapsInPassing(std::int64_t map_id) const;
  Step MapAfter(std::int64_t map_id, Ways& ways);
  Step Request(const terra_msg::deployed_t& deployed, Ways& ways) const;
  Step Baseline(std::int64_t digest, std::int64_t session, Ways& ways) const;
  template <typename Enough>
  GateEvents PosesUntil(const Enough& enough) const;
  Step PosesFor(const terra_msg::verdict_t& verdict, Ways& ways) const;
  static void Add(std::initializer_list<Step> steps, Ways& ways);
  bool HasCurrentKey(const terra_msg::verdict_t& verdict) const;

  LogContents& contents_;
  const std::int64_t session_;
  const LaterDecisions& later_;
  std::int64_t began_at_ = 0;

  // Of the call under way.
  const ReplayedGate* gate_ = nullptr;
  std::int64_t route_seq_offset_ = 0;
  std::int64_t index_ = 0;
  std::int64_t decision_ = 0;
};

/// a - b of two numbers of a log, which may be any.
std::int64_t Difference(std::int64_t a, std::int64_t b);

}  // namespace terra::logger

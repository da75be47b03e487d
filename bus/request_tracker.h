#pragma once

#include <cstdint>
#include <deque>

#include "bus/messages.h"
#include "terrain/cell.h"

namespace terra::bus {

/// What is asked of planner and gate.
struct RequestInForce {
  std::int64_t request_id = 0;  ///< 0 = nothing was asked yet.
  bool cancelled = false;
  std::int64_t map_id = 0;  ///< 0 = the map in force.
  Cell start;
  Cell goal;

  bool any() const { return request_id != 0; }
};

/// Keeps the request in force over restarts of whoever sent it.
///
/// An unseen request_id in PLAN_REQUEST replaces the current one; a replaced id
/// never comes back (the last 64 are remembered). The other side's answer
/// (DEPLOYED for the planner, BASELINE for the gate) carries the request on: it
/// is taken over where there is none, and where its sender knew the current one
/// and went on to another. It is not taken over from a sender that never named
/// the current request: that one is only late.
/// Threads: one.
class RequestTracker {
 public:
  /// Each returns true when current() changed.
  bool OnRequest(const terra_msg::plan_request_t& message);
  bool OnAnswer(const RequestInForce& carried, std::int64_t sender_session);

  const RequestInForce& current() const { return current_; }

 private:
  bool WasReplaced(std::int64_t request_id) const;
  void Replace(const RequestInForce& request);
  void Remember(std::int64_t request_id);

  RequestInForce current_;
  std::deque<std::int64_t> replaced_;
  // The session whose answer last named the current request.
  std::int64_t answered_by_ = 0;
};

}  // namespace terra::bus

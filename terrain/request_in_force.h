#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "terrain/cell.h"

namespace terra {

/// What is asked of planner and gate.
struct RequestInForce {
  std::int64_t request_id = 0;  ///< 0 = nothing was asked yet.
  bool cancelled = false;
  std::int64_t map_id = 0;  ///< 0 = the map in force.
  Cell start;
  Cell goal;

  bool any() const { return request_id != 0; }
  friend bool operator==(const RequestInForce&,
                         const RequestInForce&) = default;
};

/// Ids that were in force once; the oldest is forgotten first.
class ReplacedIds {
 public:
  explicit ReplacedIds(std::size_t capacity) : capacity_(capacity) {}

  /// 0 stands for "none" and is not remembered.
  void Add(std::int64_t id);
  bool Has(std::int64_t id) const;
  /// How many ids were added so far.
  std::int64_t num_added() const { return num_added_; }

 private:
  std::size_t capacity_;
  std::int64_t num_added_ = 0;
  std::deque<std::int64_t> ids_;
};

/// Which request is in force: the one rule that planner and gate both follow,
/// so that they cannot hold different ones after the same messages.
///
/// - An unseen request_id in PLAN_REQUEST replaces the current one. A replaced
///   id never comes back (the last kRemembered are remembered).
/// - A cancelled request stays cancelled. A request that was cancelled before
///   it came does not start.
/// - The other side's answer (BASELINE for the gate, DEPLOYED for the planner)
///   carries the request on: it is taken over where there is none, and where
///   its sender named the current request before and went on to another one.
///   A sender that never named the current request is only late.
/// - Session 0 names no sender, so its answers move nothing on.
///
/// Pure; bounded memory. Threads: one.
class RequestRule {
 public:
  static constexpr std::size_t kRemembered = 64;

  /// What became of a message.
  enum class Change {
    kOther,      ///< It is about another request than the current one.
    kSame,       ///< It is about the current one and changes nothing.
    kCancelled,  ///< The current request is cancelled now.
    kReplaced,   ///< Another request is in force now.
  };

  /// PLAN_REQUEST: go, or with `asked.cancelled` cancel.
  Change OnRequest(const RequestInForce& asked);
  /// The request that an answer names, from the sender's session.
  Change OnAnswer(const RequestInForce& carried, std::int64_t session);

  /// Goes on from a state that was in force, with nothing remembered.
  static RequestRule GoOnFrom(const RequestInForce& current,
                              std::int64_t answered_by);

  const RequestInForce& current() const { return current_; }
  /// The session whose answer last named the current request; 0 = none did.
  std::int64_t answered_by() const { return answered_by_; }
  bool WasReplaced(std::int64_t request_id) const {
    return replaced_.Has(request_id);
  }
  /// How many ids were remembered so far.
  std::int64_t num_remembered() const { return replaced_.num_added(); }

 private:
  Change Cancel();
  Change Replace(const RequestInForce& request);

  RequestInForce current_;
  ReplacedIds replaced_{kRemembered};
  std::int64_t answered_by_ = 0;
};

}  // namespace terra

#pragma once

#include <cstdint>
#include <deque>
#include <variant>
#include <vector>

#include "terrain/driven_route.h"
#include "verifier/gate.h"

namespace terra::logger {

/// What a gate hears.
using GateEvent = std::variant<verifier::MapEvent, verifier::RequestEvent,
                               verifier::BaselineEvent, verifier::AdviceEvent,
                               verifier::PoseEvent>;
using GateEvents = std::vector<GateEvent>;

/// A gate of the audit's own, which hears what a log says that the gate heard.
/// Copyable, so that the audit can try what it may have heard.
/// Threads: one.
class ReplayedGate {
 public:
  explicit ReplayedGate(const verifier::GateOptions& options)
      : gate_(options) {}

  void Hear(const GateEvents& events);

  /// What it decided and nobody has taken yet.
  std::deque<verifier::Decision>& decided() { return decided_; }
  const std::deque<verifier::Decision>& decided() const { return decided_; }

  /// What is in force, which no decision may have said yet; 0 = none.
  std::int64_t map_id() const { return map_id_; }
  std::int64_t baseline_digest() const { return baseline_.baseline_digest; }
  /// The baseline itself, as it was heard.
  const verifier::BaselineEvent& baseline() const { return baseline_; }
  const verifier::Deployed& deployed() const { return gate_.deployed(); }
  const DrivenRoute& driven() const { return gate_.driven(); }
  std::size_t poses_heard() const { return poses_heard_; }

 private:
  void Note(const verifier::MapEvent& event) { map_id_ = event.map_id; }
  void Note(const verifier::RequestEvent& event);
  void Note(const verifier::BaselineEvent& event);
  void Note(const verifier::AdviceEvent&) {}
  void Note(const verifier::PoseEvent&) { ++poses_heard_; }

  verifier::Gate gate_;
  std::deque<verifier::Decision> decided_;
  std::int64_t map_id_ = 0;
  verifier::BaselineEvent baseline_;
  std::size_t poses_heard_ = 0;
};

}  // namespace terra::logger

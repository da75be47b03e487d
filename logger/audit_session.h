#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "logger/audit.h"
#include "logger/decision_causes.h"
#include "logger/later_decisions.h"
#include "logger/log_contents.h"
#include "logger/replayed_gate.h"

namespace terra::logger {

/// Plays the inputs of one session of the gate to a gate of its own, decision
/// by decision, and compares.
/// Threads: one.
class SessionAudit {
 public:
  SessionAudit(LogContents& contents, std::int64_t session, Audit& audit);

  void Run();

 private:
  using Decided = LogContents::Decided;
  using Decisions = LaterDecisions::Decisions;

  void Take(Decisions::const_iterator at);
  void TakeState(Decisions::const_iterator at);
  void BeginUnasked(const Decisions::value_type& verdict);
  bool BeganInThisLog(std::int64_t decision);
  bool Follows(std::int64_t decision);
  void TakeFirst(const Logged<Decided>& logged);
  void BeginFrom(const terra_msg::deployed_t& deployed, std::int64_t index);
  void Decide(Decisions::const_iterator at);
  bool Fits(const ReplayedGate& gate, Decisions::const_iterator at) const;
  std::vector<ReplayedGate> GatesAfter(Decisions::const_iterator at);
  void AddGatesAfter(Decisions::const_iterator at, const ReplayedGate& gate,
                     std::vector<ReplayedGate>& after);
  bool Add(Decisions::const_iterator at, ReplayedGate gate,
           std::vector<ReplayedGate>& after) const;
  void Go(std::vector<ReplayedGate> gates, std::int64_t decision);
  void Explain(Decisions::const_iterator at);
  void PassOver(const Logged<Decided>& logged);
  Decided MessageOf(const verifier::Decision& made,
                    std::int64_t decision_offset) const;
  void Fail(Finding::Kind kind, std::int64_t decision, std::string what);

  LogContents& contents_;
  const std::int64_t session_;
  const Decisions& decisions_;
  Audit& audit_;
  LaterDecisions later_;
  DecisionCauses causes_;
  verifier::GateOptions options_;  // As the gate's CONFIG has them.
  std::string bad_config_;         // Why they are not known; empty = they are.

  // Gates that decided as the log has it so far: more than one where it cannot
  // tell how far along a route before the robot was known to be. None = the
  // state is not known.
  std::vector<ReplayedGate> gates_;
  // The log's numbers are this far ahead of the gate's own. Where the log
  // begins, the first decision tells.
  std::optional<std::int64_t> decision_offset_;
  std::int64_t route_seq_offset_ = 0;
  std::int64_t last_ = 0;
  // No decision yet but the DEPLOYED that the log begins with, and no snapshot:
  // there may have been verdicts before it began.
  bool at_begin_ = true;
  bool lost_ = false;  // A finding says why the state is not known.
};

}  // namespace terra::logger

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "logger/audit.h"
#include "logger/log_contents.h"
#include "verifier/journal_codec.h"

namespace terra::logger {

/// Plays the journal of one session of the gate to a gate of its own, step by
/// step, and compares decisions and core with what the journal and the log say.
///
/// Each step is checked by itself, from the core before it. That is the core
/// after the step before; where that step is not in the log, or was not right,
/// the core is made anew from the messages that the step names.
/// Threads: one.
class SessionAudit {
 public:
  SessionAudit(LogContents& contents, std::int64_t session, Audit& audit);

  void Run();

 private:
  using Step = terra_msg::gate_step_t;
  using Decided = LogContents::Decided;

  bool ReadOptions();
  void Take(const Logged<Step>& logged);
  bool IsPossible(const Step& step);
  void NoteGap(const Logged<Step>& logged);
  void NoteBegin(const Logged<Step>& logged);
  bool StandBefore(const Step& step);
  void PriceWhatIsInForce();
  std::optional<verifier::GateEvent> EventOf(const Step& step);
  std::optional<verifier::GateEvent> EventFromLog(const Step& step);
  bool FindMap(const Step& step, verifier::MapEvent& event);
  void Play(const Logged<Step>& logged, const verifier::GateEvent& event);
  Step StepAgain(const Step& step, const verifier::CoreNames& before,
                 const verifier::GateEvent& event,
                 const verifier::Decisions& decisions) const;
  verifier::Decisions Decide(const Step& step,
                             const verifier::GateEvent& event);
  void CompareDecision(const verifier::Decision& made,
                       const Logged<Step>& logged);
  void CheckUncovered();
  bool IsAtTheEnd(std::int64_t time_us) const;
  void Fail(Finding::Kind kind, std::int64_t decision, std::string what);

  LogContents& contents_;
  const std::int64_t session_;
  Audit& audit_;
  verifier::GateOptions options_;  // As the gate's CONFIG has them.

  // Stands after the last step; none = its state is not known.
  std::optional<verifier::Gate> gate_;
  // All steps so far were played, so the memories are what the gate's were.
  bool complete_ = false;
  std::int64_t first_step_ = 0;  // Behind the snapshot; 0 = none yet.
  std::int64_t last_step_ = 0;
  std::int64_t last_seq_ = 0;
  std::int64_t last_now_us_ = 0;
  std::int64_t last_core_ = 0;  // After the last step.
  // Decisions up to this one have their step in the log, or a gap has them.
  std::int64_t covered_ = 0;
};

}  // namespace terra::logger

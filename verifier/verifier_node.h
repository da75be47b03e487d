#pragma once

#include <cstdint>
#include <string>

#include "bus/advice_receiver.h"
#include "bus/map_receiver.h"
#include "bus/node.h"
#include "verifier/advice_queue.h"
#include "verifier/gate.h"
#include "verifier/gate_core.h"
#include "verifier/journal_node.h"

namespace terra::verifier {

/// The gate on the bus: listens to map, PLAN_REQUEST, BASELINE, POSE and, on
/// the advice bus, ADVICE; publishes DEPLOYED at once on every change and then
/// 5 times a second, and a VERDICT for each judged advice or invalid baseline.
///
/// All decisions are Gate's; this class converts messages and keeps time. The
/// deployed bus is handed over before advice in every turn (bus/event_loop.h).
/// Each event that changed the gate's core or led to a decision is written
/// down, after what was decided, as a step of the journal (docs/gate.md).
/// Advice that gets a verdict waits in an AdviceQueue; Advance judges one, so
/// the deployed bus is looked at between any two.
class VerifierNode : public bus::Node {
 public:
  /// The session of the options is the outbox's. With another one
  /// (--replay-session) the node replays: it takes the inputs of a log as they
  /// are played to it, or, once it hears a step of that session's journal,
  /// starts over and takes the journal's events alone, in their order.
  VerifierNode(GateOptions options, bus::Outbox& out);

  /// Writes the journal to a bus of its own instead of the deployed one. The
  /// outbox must outlive the node.
  void WriteJournalTo(bus::Outbox& journal) { journal_.WriteTo(journal); }

  /// Takes ADVICE from the deployed bus too: for a bus that has no second port
  /// (memq://, file://) and for log replay. The sender is the session; in a
  /// replay (option --replay-session) advice is judged in order of arrival.
  void ListenToAdvice();

  /// Takes the bytes of one ADVICE message off the advice bus. `sender` is who
  /// the receiver says it is.
  void OnAdviceBytes(SenderId sender, std::span<const std::uint8_t> bytes,
                     bus::Time now);

  /// For the heartbeat; the receiver must outlive the node.
  void Count(const bus::AdviceReceiver& receiver) { receiver_ = &receiver; }

  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  std::string last_error() const override;
  void AddCounters(bus::Counters& counters) const override;

 private:
  void OnMap(bus::Time now);
  void OnStep(const terra_msg::gate_step_t& message, bus::Time now);
  void PlayJournal(bus::Time now);
  void OnAdvice(SenderId sender, AdviceEvent event, bus::Time now);
  // Returns when the next advice may be judged.
  bus::Time JudgeOne(bus::Time now);
  void OnBaseline(const terra_msg::baseline_t& message, bus::Time now);

  /// Lets the gate decide, publishes what came of it, and writes it down.
  /// `in_journal` makes the event as the journal has it, when it is needed.
  template <typename Event, typename InJournal>
  void Decide(const Event& event, bus::Time now, std::int64_t now_us,
              const InJournal& in_journal);
  /// An event that was heard, with its message; left out where a journal is
  /// played.
  template <typename Event, typename Message>
  void Hear(const Event& event, const Message& message, bus::Time now);
  void Hear(const AdviceEvent& event, bus::Time now) {
    Hear(event, event, now);
  }
  void Send(const Verdict& verdict, std::int64_t t_det_us);
  void Send(const Deployed& deployed, bus::Time now);

  const GateOptions options_;
  const bool replays_;
  Gate gate_;
  CoreNames core_;  // After the last event.
  AdviceQueue queue_;
  bus::Outbox& out_;
  JournalWriter journal_;
  JournalPlayer player_;
  std::int64_t replay_differs_ = 0;  // Steps that ended in another core.
  bus::MapReceiver map_;
  bus::SenderTracker planner_;
  bus::Periodic repeat_{bus::kStatePeriod};
  terra_msg::deployed_t deployed_message_{};
  bus::Time changed_at_{};  // when deployed_message_ was new
  const bus::AdviceReceiver* receiver_ = nullptr;
  std::int64_t malformed_advice_ = 0;
  std::string advice_error_;
};

}  // namespace terra::verifier

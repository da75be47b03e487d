#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "bus/envelope.h"
#include "bus/map_exchange.h"
#include "bus/node.h"
#include "verifier/journal_budget.h"
#include "verifier/journal_codec.h"

namespace terra::verifier {

/// Writes the gate's journal: numbers the steps, keeps them within their rate
/// and sends them. Never waits, as no Outbox does.
///
/// At most kMaxBytesPerSecond in any second, whatever is heard. Advice and the
/// deployed bus have budgets of their own, so that advisors leave no planner's
/// baseline out. Where a budget runs low the bytes of large messages are left
/// out first, then of small ones, then whole steps; a step that is left out has
/// its number and no seq.
/// Threads: one.
class JournalWriter {
 public:
  static constexpr std::int64_t kMaxBytesPerSecond = 1'000'000;

  explicit JournalWriter(bus::Outbox& out) : out_(&out) {}

  /// From now on to another bus.
  void WriteTo(bus::Outbox& out) { out_ = &out; }

  /// The next step is the first of a gate that starts over.
  void StartOver() { steps_ = 0; }

  /// Pre: the step has neither number nor bytes yet.
  void Write(terra_msg::gate_step_t step, Bytes event_bytes);

  std::int64_t steps() const { return steps_; }
  std::int64_t without_bytes() const { return without_bytes_; }
  std::int64_t left_out() const { return left_out_; }

 private:
  bus::Outbox* out_;
  JournalBudget advice_{{.bytes_per_s = 400'000, .burst = 300'000}};
  JournalBudget deployed_bus_{{.bytes_per_s = 150'000, .burst = 150'000}};
  std::int64_t steps_ = 0;
  std::int64_t without_bytes_ = 0;
  std::int64_t left_out_ = 0;
};

/// Takes a journal off the bus and hands its events out in their order, each
/// map once the bus has brought it. Bounds: kMaxWaiting steps.
/// Threads: one.
class JournalPlayer {
 public:
  static constexpr std::size_t kMaxWaiting = 1'000;

  explicit JournalPlayer(std::int64_t session) : session_(session) {}

  /// Takes a step; returns whether it is the first of the session. Steps of
  /// other sessions and repeated ones are left out.
  bool Take(const terra_msg::gate_step_t& step);
  void Take(bus::MapPtr map);

  struct Event {
    GateEvent event;
    JournalEvent in_journal;
    std::int64_t now_us = 0;
    std::int64_t core_after = 0;
  };
  /// The next event, if it can be played.
  std::optional<Event> Next();

  /// Whether a step of the session was heard.
  bool plays() const { return last_ != 0; }
  std::size_t waiting() const { return waiting_.size(); }
  /// Steps that are not in what was played, or could not be read.
  std::int64_t missing() const { return missing_; }

 private:
  static constexpr std::size_t kMaps = 4;

  bus::MapPtr FindMap(std::int64_t map_id) const;

  std::int64_t session_;
  std::int64_t last_ = 0;
  std::int64_t missing_ = 0;
  std::deque<terra_msg::gate_step_t> waiting_;
  std::deque<bus::MapPtr> maps_;  // The newest last.
};

}  // namespace terra::verifier

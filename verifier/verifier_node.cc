#include "verifier/verifier_node.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "bus/request_tracker.h"
#include "terrain/digest.h"
#include "verifier/gate_codec.h"

namespace terra::verifier {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::gate_step_t;
using terra_msg::verdict_t;

// A planner says a baseline again at once when it has heard no answer; later
// than this after the answer it is but the usual repetition.
constexpr bus::Duration kPlannerInDoubt = std::chrono::milliseconds(100);

std::int64_t Microseconds(bus::Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             time.time_since_epoch())
      .count();
}

AdviceEvent HeardAs(const advice_t& message,
                    std::span<const std::uint8_t> bytes) {
  AdviceEvent event = ToEvent(message);
  event.heard = {message.session, message.seq, BytesDigest(bytes)};
  return event;
}

GateOptions WithSession(GateOptions options, std::int64_t session) {
  if (options.session == 0) options.session = session;
  return options;
}

}  // namespace

VerifierNode::VerifierNode(GateOptions options, bus::Outbox& out)
    : options_(WithSession(options, out.session())),
      replays_(options.session != 0),
      gate_(options_),
      core_(NamesOf(gate_)),
      out_(out),
      journal_(out),
      player_(options_.session),
      map_(out) {
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time now) {
    if (map_.OnHeader(message, now)) OnMap(now);
  });
  Listen<terra_msg::map_tile_t>([this](const auto& message, bus::Time now) {
    if (map_.OnTiles(message, now)) OnMap(now);
  });
  Listen<terra_msg::plan_request_t>([this](const auto& message, bus::Time now) {
    if (const auto asked = bus::RequestOf(message); !asked) {
      CountMalformed(bus::Channel::kPlanRequest, asked.error().message);
    } else {
      Hear(ToEvent(message), message, now);
    }
  });
  Listen<baseline_t>([this](const auto& message, bus::Time now) {
    OnBaseline(message, now);
  });
  Listen<terra_msg::pose_t>([this](const auto& message, bus::Time now) {
    Hear(ToEvent(message), message, now);
  });
  if (replays_) {
    Listen<gate_step_t>([this](const auto& message, bus::Time now) {
      OnStep(message, now);
    });
  }
}

void VerifierNode::ListenToAdvice() {
  Listen<advice_t>([this](const auto& message, bus::Time now) {
    OnAdvice(static_cast<SenderId>(message.session),
             HeardAs(message, bus::Encode(message)), now);
  });
}

void VerifierNode::OnAdviceBytes(SenderId sender,
                                 std::span<const std::uint8_t> bytes,
                                 bus::Time now) {
  const Result<advice_t> message = bus::Decode<advice_t>(bytes);
  if (message) {
    const auto size = static_cast<std::size_t>(message->getEncodedSize());
    OnAdvice(sender, HeardAs(*message, bytes.first(size)), now);
  } else {
    ++malformed_advice_;
    advice_error_ = "advice: " + message.error().message;
  }
}

// What gets no verdict costs little and takes nobody's turn.
void VerifierNode::OnAdvice(SenderId sender, AdviceEvent event, bus::Time now) {
  if (replays_ || !gate_.WouldJudge(event)) {
    Hear(event, now);
  } else {
    queue_.Add(sender, std::move(event));
  }
}

bus::Time VerifierNode::JudgeOne(bus::Time now) {
  if (queue_.size() == 0) return bus::kNever;
  if (const auto advice = queue_.Next(Microseconds(now))) Hear(*advice, now);
  const std::int64_t next_us = queue_.next_us();
  if (next_us == AdviceQueue::kNever) return bus::kNever;
  if (next_us <= Microseconds(now)) return now;
  return bus::Time(std::chrono::microseconds(next_us));
}

void VerifierNode::OnMap(bus::Time now) {
  const bus::MapPtr held = map_.map();
  if (replays_) player_.Take(held);
  const MapEvent event{std::shared_ptr<const TerrainMap>(held, &held->map),
                       held->map_id};
  Hear(event, event, now);
  PlayJournal(now);
}

// Whoever played inputs to this gate before the first step began elsewhere.
void VerifierNode::OnStep(const gate_step_t& message, bus::Time now) {
  if (player_.Take(message)) {
    gate_ = Gate(options_);
    core_ = NamesOf(gate_);
    journal_.StartOver();
  }
  PlayJournal(now);
}

void VerifierNode::PlayJournal(bus::Time now) {
  while (const auto next = player_.Next()) {
    std::visit(
        [&](const auto& event) {
          Decide(event, now, next->now_us, [&next] {
            return next->in_journal;
          });
        },
        next->event);
    if (core_.digest != next->core_after) ++replay_differs_;
  }
}

void VerifierNode::OnBaseline(const baseline_t& message, bus::Time now) {
  if (!planner_.Accept(message.session, message.seq)) return;
  const std::int64_t decision = gate_.deployed().decision;
  Hear(ToEvent(message), message, now);
  // The answer was perhaps lost, and the robot's copy of it too.
  const bool answered =
      gate_.deployed().decision == decision && gate_.deployed().has_route() &&
      message.request_id == gate_.deployed().request_id &&
      message.baseline_digest == gate_.deployed().baseline_digest;
  if (answered && now < changed_at_ + kPlannerInDoubt) {
    out_.Send(deployed_message_);
    repeat_.Postpone(now);
  }
}

template <typename Event, typename Message>
void VerifierNode::Hear(const Event& event, const Message& message,
                        bus::Time now) {
  if (player_.plays()) return;
  Decide(event, now, Microseconds(now), [&message] {
    return InJournal(message);
  });
}

template <typename Event, typename InJournal>
void VerifierNode::Decide(const Event& event, bus::Time now,
                          std::int64_t now_us, const InJournal& in_journal) {
  const std::int64_t remembered = gate_.num_remembered();
  const auto begin = bus::Clock::now();
  const Decisions decisions = gate_.On(event);
  const auto t_det = std::chrono::duration_cast<std::chrono::microseconds>(
      bus::Clock::now() - begin);
  for (const Decision& decision : decisions) {
    if (const auto* verdict = std::get_if<Verdict>(&decision)) {
      Send(*verdict, t_det.count());
    } else {
      Send(std::get<Deployed>(decision), now);
    }
  }
  const CoreNames before = std::exchange(core_, NamesOf(gate_));
  if (!decisions.empty() || core_ != before ||
      gate_.num_remembered() != remembered) {
    JournalEvent event_in_journal = in_journal();
    journal_.Write(ToStep(event_in_journal, gate_.lookup(), now_us, before,
                          decisions, core_.digest),
                   std::move(event_in_journal.bytes));
  }
}

void VerifierNode::Send(const Verdict& verdict, std::int64_t t_det_us) {
  verdict_t message = ToMessage(verdict, t_det_us);
  out_.Send(message);
}

void VerifierNode::Send(const Deployed& deployed, bus::Time now) {
  deployed_message_ = ToMessage(deployed);
  changed_at_ = now;
  out_.Send(deployed_message_);
  repeat_.Postpone(now);
}

bus::Time VerifierNode::Advance(bus::Time now) {
  const bus::Time next = std::min(map_.Advance(now), JudgeOne(now));
  if (gate_.deployed().request_id == 0) return next;
  if (repeat_.Due(now)) out_.Send(deployed_message_);
  return std::min(next, repeat_.next());
}

std::string VerifierNode::state() const {
  if (!gate_.has_map()) return map_.state();
  switch (gate_.deployed().mode) {
    case Mode::kNone:
      return "ready, nothing deployed";
    case Mode::kBaseline:
      return "ready, baseline deployed";
    case Mode::kCandidate:
      return "ready, candidate deployed";
    case Mode::kHold:
      return "on hold: no valid route";
  }
  return "ready";
}

// What others said wrong hides nothing that is wrong with the map, and advice
// nothing that is wrong with the baseline.
std::string VerifierNode::last_error() const {
  if (!map_.last_error().empty()) return map_.last_error();
  const std::string malformed = Node::last_error();
  return malformed.empty() ? advice_error_ : malformed;
}

void VerifierNode::AddCounters(bus::Counters& counters) const {
  Node::AddCounters(counters);
  const GateCounters& gate = gate_.counters();
  counters.emplace_back("judged", gate.judged);
  counters.emplace_back("accepted", gate.accepted);
  counters.emplace_back("repeats", gate.repeats);
  counters.emplace_back("unknown_key", gate.unknown_key);
  counters.emplace_back("failed_advice", gate.failed_advice);
  counters.emplace_back("invalid_baselines", gate.invalid_baselines);
  counters.emplace_back("other_baselines", gate.other_baselines);
  counters.emplace_back("other_poses", gate.other_poses);
  counters.emplace_back("malformed_advice", malformed_advice_);
  counters.emplace_back("advice_waiting",
                        static_cast<std::int64_t>(queue_.size()));
  counters.emplace_back("advice_without_room", queue_.dropped());
  counters.emplace_back("journal_steps", journal_.steps());
  counters.emplace_back("journal_without_bytes", journal_.without_bytes());
  counters.emplace_back("journal_left_out", journal_.left_out());
  if (player_.plays()) {
    counters.emplace_back("replay_waiting",
                          static_cast<std::int64_t>(player_.waiting()));
    counters.emplace_back("replay_missing", player_.missing());
    counters.emplace_back("replay_differs", replay_differs_);
  }
  counters.emplace_back("lost", static_cast<std::int64_t>(map_.sender().lost() +
                                                          planner_.lost()));
  counters.emplace_back("from_replaced_planner", planner_.from_replaced());
  if (receiver_ != nullptr) {
    const bus::AdviceReceiver::Counters& bus = receiver_->counters();
    const auto add = [&counters](const char* name, std::uint64_t value) {
      counters.emplace_back(name, static_cast<std::int64_t>(value));
    };
    add("advice_received", bus.received);
    add("advice_malformed", bus.malformed);
    add("advice_over_limit", bus.over_limit);
    add("advice_lost_in_kernel", bus.lost_in_kernel);
  }
}

}  // namespace terra::verifier

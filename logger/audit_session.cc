#include "logger/audit_session.h"

#include <algorithm>
#include <utility>

#include "logger/gate_state.h"
#include "verifier/gate_codec.h"
#include "verifier/gate_options.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::verdict_t;

// A bound on work; more than two have not been seen.
constexpr std::size_t kMaxGates = 4;

std::int64_t Sum(std::int64_t a, std::int64_t b) {
  return Difference(a, Difference(0, b));
}

std::int64_t NumberOf(const verifier::Decision& decided) {
  return std::visit(
      [](const auto& one) {
        return one.decision;
      },
      decided);
}

}  // namespace

SessionAudit::SessionAudit(LogContents& contents, std::int64_t session,
                           Audit& audit)
    : contents_(contents),
      session_(session),
      decisions_(contents.decisions.at(session)),
      audit_(audit),
      later_(decisions_),
      causes_(contents, session, later_) {
  const auto config = contents_.configs.find(session);
  if (config != contents_.configs.end()) {
    Result<verifier::GateOptions> read =
        verifier::ReadGateOptions(config->second.message.config_text);
    if (read.ok()) {
      options_ = *read;
    } else {
      bad_config_ = read.error().message;
    }
  }
  options_.session = session;
}

void SessionAudit::Run() {
  if (!bad_config_.empty()) {
    audit_.Add({Finding::Kind::kMissingInput, session_, 0,
                "the CONFIG of this gate cannot be read, so its margin is not "
                "known: " +
                    bad_config_});
    return;
  }
  for (auto at = decisions_.begin(); at != decisions_.end(); ++at) Take(at);
}

void SessionAudit::Take(Decisions::const_iterator at) {
  const std::int64_t decision = at->first;
  const Logged<Decided>& logged = at->second;
  if (logged.index < contents_.state_end) {
    TakeState(at);
  } else if (decision == 1) {
    gates_.assign(1, ReplayedGate(options_));
    decision_offset_ = 0;
    route_seq_offset_ = 0;
    causes_.BeginAt(0);
    Decide(at);
  } else if (Follows(decision) && !gates_.empty()) {
    Decide(at);
  } else {
    TakeFirst(logged);
  }
  last_ = decision;
}

// The snapshot's DEPLOYED is the state to begin from, if anything goes on from
// there: that of a gate which has ended may name a map of long ago. Its VERDICT
// tells how many decisions there were, and may have led to the next DEPLOYED;
// that its inputs are gone is no finding, since it stands in the part before.
void SessionAudit::TakeState(Decisions::const_iterator at) {
  at_begin_ = false;
  if (decisions_.rbegin()->second.index < contents_.state_end) return;
  if (const auto* deployed = std::get_if<deployed_t>(&at->second.message)) {
    BeginFrom(*deployed, at->second.index);
  } else if (gates_.empty() && !lost_) {
    BeginUnasked(*at);
  } else if (std::vector<ReplayedGate> after = GatesAfter(at); !after.empty()) {
    Go(std::move(after), at->first);
  }
}

// The snapshot has no DEPLOYED of this gate, so it was not asked for a route
// yet and knew cancelled requests only.
void SessionAudit::BeginUnasked(const Decisions::value_type& verdict) {
  ReplayedGate gate(options_);
  for (const std::int64_t id : later_.ReplacedBefore(verdict.first).requests) {
    gate.Hear({verifier::RequestEvent{id, true, {}, {}}});
  }
  gates_.assign(1, std::move(gate));
  decision_offset_ = verdict.first;
  route_seq_offset_ = 0;
  causes_.BeginAt(verdict.second.index);
}

// Returns whether the last decision before this one is known, and reports a gap
// if not.
bool SessionAudit::Follows(std::int64_t decision) {
  if (last_ == 0) return !BeganInThisLog(decision);
  if (decision - 1 == last_) return true;
  if (at_begin_) return true;  // Verdicts from before the log.
  Fail(Finding::Kind::kGap, decision,
       "decisions after " + std::to_string(last_) + " to " +
           std::to_string(decision - 1) + " are not in the log");
  return false;
}

// A gate after another one of this log began in this log too, and said so.
bool SessionAudit::BeganInThisLog(std::int64_t decision) {
  const std::int64_t index = decisions_.begin()->second.index;
  const bool first =
      std::ranges::none_of(contents_.decisions, [index](const auto& session) {
        return session.second.begin()->second.index < index;
      });
  if (first) return false;
  Fail(Finding::Kind::kGap, decision,
       "decisions before " + std::to_string(decision) + " are not in the log");
  return true;
}

void SessionAudit::TakeFirst(const Logged<Decided>& logged) {
  if (const auto* deployed = std::get_if<deployed_t>(&logged.message)) {
    BeginFrom(*deployed, logged.index);
    return;
  }
  at_begin_ = false;
  const auto& verdict = std::get<verdict_t>(logged.message);
  // What was in force has not been repeated yet, or a finding says why it is
  // not known.
  if (logged.index < contents_.first_deployed || lost_) {
    ++audit_.unchecked;
    return;
  }
  Fail(Finding::Kind::kMissingInput, verdict.decision,
       "no DEPLOYED before this verdict says what was in force");
}

void SessionAudit::BeginFrom(const deployed_t& deployed, std::int64_t index) {
  gates_.clear();
  Result<ReplayedGate> gate = GateInState(
      deployed, contents_, options_, later_.ReplacedBefore(deployed.decision));
  if (!gate) {
    Fail(gate.error().code == ErrorCode::kNotFound
             ? Finding::Kind::kMissingInput
             : Finding::Kind::kMismatch,
         deployed.decision, gate.error().message);
    return;
  }
  gate->decided().clear();
  route_seq_offset_ =
      Difference(deployed.route_seq, gate->deployed().route_seq);
  gates_.assign(1, *std::move(gate));
  lost_ = false;
  decision_offset_.reset();
  causes_.BeginAt(index);
  ++audit_.anchors;
}

void SessionAudit::Decide(Decisions::const_iterator at) {
  std::vector<ReplayedGate> after = GatesAfter(at);
  if (after.empty()) return Explain(at);
  at_begin_ = false;
  Go(std::move(after), at->first);
  ++(std::holds_alternative<verdict_t>(at->second.message) ? audit_.verdicts
                                                           : audit_.deployed);
}

// These gates made the decision. The first one of a log tells how the log's
// numbers differ from theirs.
void SessionAudit::Go(std::vector<ReplayedGate> gates, std::int64_t decision) {
  gates_ = std::move(gates);
  if (!decision_offset_) {
    decision_offset_ =
        Difference(decision, NumberOf(gates_.front().decided().front()));
  }
  for (ReplayedGate& gate : gates_) gate.decided().pop_front();
}

// Reports a decision that no gate made, by what the likeliest one makes of it.
void SessionAudit::Explain(Decisions::const_iterator at) {
  const std::string said = "the log says " + InWords(at->second.message);
  ReplayedGate& gate = gates_.front();
  if (gate.decided().empty()) {
    const Ways ways = causes_.WaysTo(at->second, gate, route_seq_offset_);
    if (ways.num_advice != 1 && audit_.advice_turned_away > 0) {
      return PassOver(at->second);
    }
    if (!ways.missing.empty()) {
      return Fail(Finding::Kind::kMissingInput, at->first, ways.missing);
    }
    if (!ways.all.empty()) gate.Hear(ways.all.back());
  }
  if (gate.decided().empty()) {
    return Fail(Finding::Kind::kMismatch, at->first,
                said + ", but from its inputs follows nothing");
  }
  const verifier::Decision& front = gate.decided().front();
  const std::int64_t offset =
      decision_offset_.value_or(Difference(at->first, NumberOf(front)));
  Fail(Finding::Kind::kMismatch, at->first,
       said + ", but from its inputs follows " +
           InWords(MessageOf(front, offset)));
}

// A verdict on advice that the recorder turned away in a flood and the gate
// looked at. What is refused changes nothing but the gate's count of decisions;
// where it was accepted, the DEPLOYED that follows is the state to go on from.
void SessionAudit::PassOver(const Logged<Decided>& logged) {
  ++audit_.unrecorded;
  if (std::get<verdict_t>(logged.message).code == verdict_t::CODE_ACCEPTED) {
    lost_ = true;
    gates_.clear();
  } else if (decision_offset_) {
    decision_offset_ = Sum(*decision_offset_, 1);
  }
}

// The gates from which the logged decision follows.
std::vector<ReplayedGate> SessionAudit::GatesAfter(
    Decisions::const_iterator at) {
  std::vector<ReplayedGate> after;
  for (const ReplayedGate& gate : gates_) AddGatesAfter(at, gate, after);
  return after;
}

// Goes the first way from which the logged decision follows, if there is one.
void SessionAudit::AddGatesAfter(Decisions::const_iterator at,
                                 const ReplayedGate& gate,
                                 std::vector<ReplayedGate>& after) {
  if (!gate.decided().empty()) {
    Add(at, gate, after);
    return;
  }
  const Ways ways = causes_.WaysTo(at->second, gate, route_seq_offset_);
  for (const GateEvents& way : ways.all) {
    ReplayedGate trial = gate;
    trial.Hear(way);
    if (!Add(at, trial, after)) continue;
    if (trial.deployed().route_seq != gate.deployed().route_seq) {
      // How far the robot was known to be decides what is kept of its place.
      ReplayedGate driven_on = gate;
      driven_on.Hear(causes_.AllPoses());
      driven_on.Hear(way);
      Add(at, std::move(driven_on), after);
    }
    return;
  }
}

// Adds a gate that decided as the log has it, unless there is one like it.
bool SessionAudit::Add(Decisions::const_iterator at, ReplayedGate gate,
                       std::vector<ReplayedGate>& after) const {
  if (!Fits(gate, at)) return false;
  const auto is_alike = [&gate](const ReplayedGate& other) {
    return other.driven().place() == gate.driven().place() &&
           other.driven().on_route() == gate.driven().on_route() &&
           other.decided().size() == gate.decided().size();
  };
  if (after.size() < kMaxGates && std::ranges::none_of(after, is_alike)) {
    after.push_back(std::move(gate));
  }
  return true;
}

// Returns whether what a gate decided is what the log has from here on.
bool SessionAudit::Fits(const ReplayedGate& gate,
                        Decisions::const_iterator at) const {
  if (gate.decided().empty()) return false;
  const std::int64_t offset = decision_offset_.value_or(
      Difference(at->first, NumberOf(gate.decided().front())));
  for (const verifier::Decision& made : gate.decided()) {
    if (at == decisions_.end()) return true;
    if (Essence(MessageOf(made, offset)) != Essence(at->second.message)) {
      return false;
    }
    ++at;
  }
  return true;
}

// A decision of this audit's gate as the log would have it.
LogContents::Decided SessionAudit::MessageOf(
    const verifier::Decision& made, std::int64_t decision_offset) const {
  if (const auto* verdict = std::get_if<verifier::Verdict>(&made)) {
    verifier::Verdict numbered = *verdict;
    numbered.decision = Sum(numbered.decision, decision_offset);
    numbered.route_seq_before =
        Sum(numbered.route_seq_before, route_seq_offset_);
    if (numbered.anchor.session == session_) {
      numbered.anchor.route_seq =
          Sum(numbered.anchor.route_seq, route_seq_offset_);
    }
    return verifier::ToMessage(numbered, 0);
  }
  verifier::Deployed numbered = std::get<verifier::Deployed>(made);
  numbered.decision = Sum(numbered.decision, decision_offset);
  numbered.route_seq = Sum(numbered.route_seq, route_seq_offset_);
  return verifier::ToMessage(numbered);
}

void SessionAudit::Fail(Finding::Kind kind, std::int64_t decision,
                        std::string what) {
  lost_ = true;
  gates_.clear();
  audit_.Add({kind, session_, decision, std::move(what)});
}

}  // namespace terra::logger

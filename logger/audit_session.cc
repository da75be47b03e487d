#include "logger/audit_session.h"

#include <cstdlib>
#include <utility>

#include "logger/gate_state.h"
#include "verifier/gate_codec.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::verdict_t;

// The gate's only option that decides anything, from its CONFIG.
double MarginIn(const std::string& config) {
  constexpr std::string_view kKey = "margin=";
  std::size_t at = config.find(kKey);
  while (at != std::string::npos && at > 0 && config[at - 1] != '\n') {
    at = config.find(kKey, at + 1);
  }
  return at == std::string::npos
             ? 0.0
             : std::strtod(config.c_str() + at + kKey.size(), nullptr);
}

std::int64_t Sum(std::int64_t a, std::int64_t b) {
  return Difference(a, Difference(0, b));
}

std::int64_t NumberOf(const LogContents::Decided& decided) {
  return std::visit(
      [](const auto& one) {
        return one.decision;
      },
      decided);
}

std::int64_t NumberOf(const verifier::Decision& decided) {
  return std::visit(
      [](const auto& one) {
        return one.decision;
      },
      decided);
}

std::string InWords(const LogContents::Decided& decided) {
  if (const auto* verdict = std::get_if<verdict_t>(&decided)) {
    return "VERDICT " +
           std::string(verifier::CodeName(verifier::Code{verdict->code})) +
           ", cost " + std::to_string(verdict->candidate_cost) + " against " +
           std::to_string(verdict->cost_to_beat);
  }
  const auto& deployed = std::get<deployed_t>(decided);
  return "DEPLOYED route " + std::to_string(deployed.route_seq) + " in mode " +
         std::to_string(deployed.mode) + ", cause " +
         std::to_string(deployed.cause) + ", cost " +
         std::to_string(deployed.deployed_cost) + " against " +
         std::to_string(deployed.baseline_cost);
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
  options_.session = session;
  const auto config = contents_.configs.find(session);
  if (config != contents_.configs.end()) {
    options_.margin = MarginIn(config->second.message.config_text);
  }
}

void SessionAudit::Run() {
  for (auto at = decisions_.begin(); at != decisions_.end(); ++at) Take(at);
}

void SessionAudit::Take(Decisions::const_iterator at) {
  const std::int64_t decision = at->first;
  const Logged<Decided>& logged = at->second;
  if (logged.index < contents_.state_end) {
    TakeState(logged);
  } else if (decision == 1) {
    gate_.emplace(options_);
    decision_offset_ = 0;
    route_seq_offset_ = 0;
    causes_.BeginAt(0);
    Decide(at);
  } else if (Follows(decision) && gate_) {
    Decide(at);
  } else {
    TakeFirst(logged);
  }
  last_ = decision;
}

// The snapshot's DEPLOYED is the state to begin from, its VERDICT tells only
// how many decisions there were: its inputs may be gone.
void SessionAudit::TakeState(const Logged<Decided>& logged) {
  at_begin_ = false;
  const auto* deployed = std::get_if<deployed_t>(&logged.message);
  if (deployed != nullptr) BeginFrom(*deployed, logged.index);
}

// Returns whether the last decision before this one is known, and reports a gap
// if not.
bool SessionAudit::Follows(std::int64_t decision) {
  if (last_ == 0 || decision - 1 == last_) return true;
  if (at_begin_ && gate_) return true;  // Verdicts from before the log.
  Fail(Finding::Kind::kGap, decision,
       "decisions after " + std::to_string(last_) + " to " +
           std::to_string(decision - 1) + " are not in the log");
  gate_.reset();
  return false;
}

void SessionAudit::TakeFirst(const Logged<Decided>& logged) {
  if (const auto* deployed = std::get_if<deployed_t>(&logged.message)) {
    BeginFrom(*deployed, logged.index);
    return;
  }
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
  gate_.reset();
  Result<ReplayedGate> gate = GateInState(
      deployed, contents_, options_, later_.ReplacedBefore(deployed.decision));
  if (!gate) {
    Fail(gate.error().code == ErrorCode::kNotFound
             ? Finding::Kind::kMissingInput
             : Finding::Kind::kMismatch,
         deployed.decision, gate.error().message);
    return;
  }
  gate_ = *std::move(gate);
  lost_ = false;
  gate_->decided().clear();
  decision_offset_.reset();
  route_seq_offset_ =
      Difference(deployed.route_seq, gate_->deployed().route_seq);
  causes_.BeginAt(index);
  ++audit_.anchors;
}

void SessionAudit::Decide(Decisions::const_iterator at) {
  if (gate_->decided().empty()) {
    const Ways ways = causes_.WaysTo(at->second, *gate_, route_seq_offset_);
    bool fits = false;
    for (std::size_t i = 0; i < ways.all.size() && !fits; ++i) {
      // The last one is not only tried: it shows what differs.
      const bool last = i + 1 == ways.all.size() && ways.missing.empty();
      if (last) {
        gate_->Hear(ways.all[i]);
        fits = true;
        break;
      }
      ReplayedGate trial = *gate_;
      trial.Hear(ways.all[i]);
      fits = Fits(trial, at);
      if (fits) gate_ = std::move(trial);
    }
    if (!fits && !ways.missing.empty()) {
      Fail(Finding::Kind::kMissingInput, at->first, ways.missing);
      gate_.reset();
      return;
    }
  }
  if (gate_->decided().empty()) {
    Fail(Finding::Kind::kMismatch, at->first,
         "the log says " + InWords(at->second.message) +
             ", but from its inputs follows nothing");
    gate_.reset();
    return;
  }
  Compare(at->second.message);
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

void SessionAudit::Compare(const Decided& logged) {
  const verifier::Decision made = std::move(gate_->decided().front());
  gate_->decided().pop_front();
  if (!decision_offset_) {
    decision_offset_ = Difference(NumberOf(logged), NumberOf(made));
  }
  at_begin_ = false;
  const bool is_verdict = std::holds_alternative<verdict_t>(logged);
  const Decided message = MessageOf(made, *decision_offset_);
  if (Essence(message) == Essence(logged)) {
    ++(is_verdict ? audit_.verdicts : audit_.deployed);
    return;
  }
  Fail(Finding::Kind::kMismatch, NumberOf(logged),
       "the log says " + InWords(logged) + ", but from its inputs follows " +
           InWords(message));
  gate_.reset();
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
  audit_.Add({kind, session_, decision, std::move(what)});
}

}  // namespace terra::logger

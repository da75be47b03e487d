#include "logger/audit_session.h"

#include <algorithm>
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
    TakeState(at);
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

// The snapshot's DEPLOYED is the state to begin from, if anything goes on from
// there: that of a gate which has ended may name a map of long ago. Its VERDICT
// tells how many decisions there were, and may have led to the next DEPLOYED;
// that its inputs are gone is no finding, since it stands in the part before.
void SessionAudit::TakeState(Decisions::const_iterator at) {
  at_begin_ = false;
  if (decisions_.rbegin()->second.index < contents_.state_end) return;
  if (const auto* deployed = std::get_if<deployed_t>(&at->second.message)) {
    BeginFrom(*deployed, at->second.index);
  } else if (!gate_ && !lost_) {
    BeginUnasked(*at);
  } else if (gate_ &&
             Hear(at, causes_.WaysTo(at->second, *gate_, route_seq_offset_))) {
    Number(at->first);
    gate_->decided().pop_front();
  }
}

// The snapshot has no DEPLOYED of this gate, so it was not asked for a route
// yet and knew cancelled requests only.
void SessionAudit::BeginUnasked(const Decisions::value_type& verdict) {
  gate_.emplace(options_);
  for (const std::int64_t id : later_.ReplacedBefore(verdict.first).requests) {
    gate_->Hear({verifier::RequestEvent{id, true, {}, {}}});
  }
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
  const std::string said = "the log says " + InWords(at->second.message);
  if (gate_->decided().empty()) {
    const Ways ways = causes_.WaysTo(at->second, *gate_, route_seq_offset_);
    if (!Hear(at, ways) && !ways.missing.empty()) {
      return Fail(Finding::Kind::kMissingInput, at->first, ways.missing);
    }
    // The last one shows what differs.
    if (gate_->decided().empty() && !ways.all.empty()) {
      gate_->Hear(ways.all.back());
    }
  }
  if (gate_->decided().empty()) {
    return Fail(Finding::Kind::kMismatch, at->first,
                said + ", but from its inputs follows nothing");
  }
  at_begin_ = false;
  Number(at->first);
  const Decided made = MessageOf(gate_->decided().front(), *decision_offset_);
  gate_->decided().pop_front();
  if (Essence(made) != Essence(at->second.message)) {
    return Fail(Finding::Kind::kMismatch, at->first,
                said + ", but from its inputs follows " + InWords(made));
  }
  ++(std::holds_alternative<verdict_t>(made) ? audit_.verdicts
                                             : audit_.deployed);
}

// Goes the first way from which the logged decision follows; returns false when
// there is none.
bool SessionAudit::Hear(Decisions::const_iterator at, const Ways& ways) {
  for (const GateEvents& way : ways.all) {
    ReplayedGate trial = *gate_;
    trial.Hear(way);
    if (Fits(trial, at)) {
      gate_ = std::move(trial);
      return true;
    }
  }
  return false;
}

// The first decision tells how the log's numbers differ from this gate's.
void SessionAudit::Number(std::int64_t decision) {
  if (decision_offset_) return;
  decision_offset_ = Difference(decision, NumberOf(gate_->decided().front()));
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
  gate_.reset();
  audit_.Add({kind, session_, decision, std::move(what)});
}

}  // namespace terra::logger

#include <utility>

#include "verifier/gate.h"

// The part of the gate that judges advice.
namespace terra::verifier {
namespace {

// Any byte may stand in a message's kind.
bool IsAnswer(AdviceKind kind) {
  return kind == AdviceKind::kRetain || kind == AdviceKind::kPropose ||
         kind == AdviceKind::kMalformed;
}

bool IsWellFormed(const AdviceEvent& event) {
  return IsAnswer(event.kind) && event.advisor.size() <= kMaxNameBytes;
}

}  // namespace

bool Gate::WouldJudge(const AdviceEvent& event) const {
  return event.kind != AdviceKind::kFailed && CheckKey(event) &&
         !judged_.Has(event);
}

Decisions Gate::OnGiven(const AdviceEvent& event, Lookup lookup) {
  given_ = lookup;
  Decisions out = On(event);
  given_.reset();
  return out;
}

Decisions Gate::On(const AdviceEvent& event) {
  Decisions out;
  lookup_ = Lookup::kNone;
  if (event.kind == AdviceKind::kFailed) {
    ++counters_.failed_advice;
    return out;
  }
  const std::optional<Code> key = CheckKey(event);
  if (!key) {
    lookup_ = Lookup::kUnknown;
    ++counters_.unknown_key;
    return out;
  }
  if (!judged_.Add(event) && !given_) {
    lookup_ = Lookup::kRepeat;
    ++counters_.repeats;
    return out;
  }
  // What a cancel makes stale needs no memory.
  const bool of_cancelled =
      request().cancelled && event.request_id == request().request_id;
  lookup_ = *key == Code::kNotChecked || of_cancelled ? Lookup::kNew
                                                      : Lookup::kReplaced;
  ++counters_.judged;
  Verdict verdict;
  verdict.decision = ++decisions_;
  verdict.request_id = event.request_id;
  verdict.map_id = event.map_id;
  verdict.baseline_digest = event.baseline_digest;
  verdict.anchor = event.anchor;
  verdict.advisor = event.advisor;
  verdict.advisor_session = event.session;
  verdict.attempt = event.attempt;
  verdict.candidate = event.candidate;
  verdict.code = IsWellFormed(event) ? *key : Code::kMalformedMessage;
  verdict.route_seq_before = deployed_.route_seq;
  std::optional<PricedRoute> accepted;
  if (verdict.code == Code::kNotChecked) accepted = Judge(event, verdict);
  out.emplace_back(std::move(verdict));
  if (accepted) {
    ++counters_.accepted;
    Deploy(Upgrade(event, *std::move(accepted)), out);
  }
  return out;
}

Decisions Gate::On(const PoseEvent& event) {
  lookup_ = Lookup::kNone;
  if (InForce(event.session, event.route_seq)) {
    driven_.OnPose(event.cell);
  } else {
    ++counters_.other_poses;
  }
  return {};
}

bool Gate::InForce(std::int64_t session, std::int64_t route_seq) const {
  return session != 0 && session == options_.session &&
         route_seq == deployed_.route_seq && deployed_.has_route();
}

// Without a map there is no baseline.
std::optional<Code> Gate::CheckKey(const AdviceEvent& event) const {
  if (event.request_id != request().request_id || !request().any()) {
    return IfReplaced(requests_.WasReplaced(event.request_id),
                      Code::kStaleRequest);
  }
  if (request().cancelled) return Code::kStaleRequest;
  if (event.map_id != map_id_) {
    return IfReplaced(replaced_maps_.Has(event.map_id), Code::kStaleMap);
  }
  if (!baseline_ ||
      event.baseline_digest != baseline_->message.baseline_digest) {
    return IfReplaced(replaced_baselines_.Has(event.baseline_digest),
                      Code::kStaleBaseline);
  }
  return Code::kNotChecked;
}

std::optional<Code> Gate::IfReplaced(bool remembered, Code stale) const {
  const bool replaced = given_ ? *given_ == Lookup::kReplaced : remembered;
  return replaced ? std::optional(stale) : std::nullopt;
}

std::optional<Gate::PricedRoute> Gate::Judge(const AdviceEvent& event,
                                             Verdict& verdict) const {
  verdict.baseline_cost = baseline_->check.cost;
  if (!baseline_valid()) {
    verdict.code = Code::kBaselineInvalid;
  } else if (!AnchorInForce(event.anchor)) {
    verdict.code = Code::kLate;
  } else if (event.kind == AdviceKind::kRetain) {
    verdict.code = Code::kRetained;
  } else if (event.kind == AdviceKind::kMalformed) {
    verdict.code = Code::kParseError;
  } else {
    return JudgeProposal(event, verdict);
  }
  return std::nullopt;
}

// The start stays an anchor whichever route is in force, until it is passed.
bool Gate::AnchorInForce(const Anchor& anchor) const {
  return (anchor.index == 0 || InForce(anchor.session, anchor.route_seq)) &&
         !driven_.Passed(anchor.index);
}

// Candidate and deployed route share their cells up to the anchor, so what
// follows the anchor is compared; only the baseline may differ before it.
std::optional<Gate::PricedRoute> Gate::JudgeProposal(const AdviceEvent& event,
                                                     Verdict& verdict) const {
  const Cell anchor = driven_.cell(event.anchor.index);
  verdict.cost_to_beat = driven_.CostFrom(*map_, event.anchor.index);
  if (event.anchor.cell != anchor) {
    verdict.code = Code::kStartMismatch;
    verdict.fail_cell = event.anchor.cell;
    return std::nullopt;
  }
  const RouteCheck check =
      CheckRoute(*map_, event.waypoints, anchor, request().goal, kBusLimits);
  verdict.candidate_cost = check.cost;
  if (!check.feasible()) {
    verdict.code = check.code;
    verdict.fail_segment = check.segment;
    verdict.fail_cell = check.cell;
    return std::nullopt;
  }
  PricedRoute whole{driven_.JoinAt(event.anchor.index, event.waypoints), 0};
  const RouteCheck joined = CheckRoute(*map_, whole.waypoints, request().start,
                                       request().goal, kBusLimits);
  whole.cost = joined.cost;
  if (!joined.feasible()) {
    verdict.code = joined.code;
  } else if (!StrictlyCheaper(joined.cost, baseline_->check.cost)) {
    verdict.code = Code::kNotCheaper;
  } else if (!StrictlyCheaper(check.cost, verdict.cost_to_beat)) {
    verdict.code = Code::kNotBest;
  } else if (!(verdict.cost_to_beat - check.cost > options_.margin)) {
    verdict.code = Code::kBelowMargin;
  } else {
    verdict.code = Code::kAccepted;
    return whole;
  }
  return std::nullopt;
}

Deployed Gate::Upgrade(const AdviceEvent& event, PricedRoute route) const {
  Deployed next;
  next.mode = Mode::kCandidate;
  next.cause = Cause::kUpgrade;
  next.baseline_digest = event.baseline_digest;
  next.source = event.advisor;
  next.source_session = event.session;
  next.source_attempt = event.attempt;
  next.source_candidate = event.candidate;
  next.waypoints = std::move(route.waypoints);
  next.cost = route.cost;
  next.baseline_cost = baseline_->check.cost;
  return next;
}

}  // namespace terra::verifier

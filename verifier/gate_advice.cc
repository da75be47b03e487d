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

}  // namespace

Decisions Gate::On(const AdviceEvent& event) {
  Decisions out;
  if (event.kind == AdviceKind::kFailed) {
    ++counters_.failed_advice;
    return out;
  }
  const std::optional<Code> key = CheckKey(event);
  if (!key) {
    ++counters_.unknown_key;
    return out;
  }
  if (!judged_.Add(event)) {
    ++counters_.repeats;
    return out;
  }
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
  verdict.code = IsAnswer(event.kind) ? *key : Code::kMalformedMessage;
  verdict.route_seq_before = deployed_.route_seq;
  if (verdict.code == Code::kNotChecked) {
    Judge(event, verdict);
  }
  const Code code = verdict.code;
  const double cost = verdict.candidate_cost;
  out.emplace_back(std::move(verdict));
  if (code == Code::kAccepted) {
    ++counters_.accepted;
    Deploy(Upgrade(event, cost), out);
  }
  return out;
}

std::optional<Code> Gate::CheckKey(const AdviceEvent& event) const {
  if (event.request_id != request_.id || request_.id == 0) {
    return replaced_requests_.Has(event.request_id)
               ? std::optional(Code::kStaleRequest)
               : std::nullopt;
  }
  if (request_.cancelled) return Code::kStaleRequest;
  if (map_ == nullptr || event.map_id != map_id_) {
    return replaced_maps_.Has(event.map_id) ? std::optional(Code::kStaleMap)
                                            : std::nullopt;
  }
  if (!baseline_ ||
      event.baseline_digest != baseline_->message.baseline_digest) {
    return replaced_baselines_.Has(event.baseline_digest)
               ? std::optional(Code::kStaleBaseline)
               : std::nullopt;
  }
  return Code::kNotChecked;
}

void Gate::Judge(const AdviceEvent& event, Verdict& verdict) const {
  verdict.baseline_cost = baseline_->check.cost;
  verdict.cost_to_beat = deployed_.cost;
  if (!baseline_valid()) {
    verdict.code = Code::kBaselineInvalid;
    return;
  }
  // Advice for a robot that moves is not taken yet: fail closed.
  if (event.anchor.index != 0) {
    verdict.code = Code::kLate;
    return;
  }
  if (event.kind == AdviceKind::kRetain) {
    verdict.code = Code::kRetained;
  } else if (event.kind == AdviceKind::kMalformed) {
    verdict.code = Code::kParseError;
  } else {
    JudgeProposal(event, verdict);
  }
}

void Gate::JudgeProposal(const AdviceEvent& event, Verdict& verdict) const {
  if (event.anchor.cell != request_.start) {
    verdict.code = Code::kStartMismatch;
    verdict.fail_cell = event.anchor.cell;
    return;
  }
  const RouteCheck check = CheckRoute(*map_, event.waypoints, request_.start,
                                      request_.goal, kBusLimits);
  verdict.candidate_cost = check.cost;
  if (!check.feasible()) {
    verdict.code = check.code;
    verdict.fail_segment = check.segment;
    verdict.fail_cell = check.cell;
  } else if (!StrictlyCheaper(check.cost, baseline_->check.cost)) {
    verdict.code = Code::kNotCheaper;
  } else if (!StrictlyCheaper(check.cost, deployed_.cost)) {
    verdict.code = Code::kNotBest;
  } else if (!(deployed_.cost - check.cost > options_.margin)) {
    verdict.code = Code::kBelowMargin;
  } else {
    verdict.code = Code::kAccepted;
  }
}

Deployed Gate::Upgrade(const AdviceEvent& event, double cost) const {
  Deployed next;
  next.mode = Mode::kCandidate;
  next.cause = Cause::kUpgrade;
  next.baseline_digest = event.baseline_digest;
  next.source = event.advisor;
  next.source_session = event.session;
  next.source_attempt = event.attempt;
  next.source_candidate = event.candidate;
  next.waypoints = event.waypoints;
  next.cost = cost;
  next.baseline_cost = baseline_->check.cost;
  return next;
}

}  // namespace terra::verifier

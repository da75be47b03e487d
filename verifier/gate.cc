#include "verifier/gate.h"

#include <algorithm>
#include <utility>

#include "terrain/digest.h"
#include "terrain/require.h"

namespace terra::verifier {
namespace {

// Judged advice that is remembered, so that repeats get no second verdict. The
// advice bus admits 200 messages a second, each repeated once a second.
constexpr std::size_t kRememberedAdvice = 4'096;

}  // namespace

void Gate::Replaced::Add(std::int64_t id) {
  if (id == 0 || Has(id)) return;
  ids_.push_back(id);
  if (ids_.size() > capacity_) ids_.pop_front();
}

bool Gate::Replaced::Has(std::int64_t id) const {
  return std::find(ids_.begin(), ids_.end(), id) != ids_.end();
}

// ---- Requests ----

Decisions Gate::On(const RequestEvent& event) {
  Decisions out;
  if (event.request_id == 0) return out;
  if (event.request_id == request_.id) {
    if (event.cancel && !request_.cancelled) {
      request_.cancelled = true;
      DropBaseline();
      DeployNothing(Mode::kNone, Cause::kCancelled, out);
    }
    return out;
  }
  if (replaced_requests_.Has(event.request_id)) return out;
  if (event.cancel) {
    // Of a request that never came: it must not start later.
    replaced_requests_.Add(event.request_id);
    return out;
  }
  Replace(Request{event.request_id, false, event.start, event.goal}, out);
  return out;
}

void Gate::Replace(const Request& request, Decisions& out) {
  replaced_requests_.Add(request_.id);
  DropBaseline();
  request_ = request;
  answered_by_ = 0;
  // The route of the old request leads elsewhere.
  DeployNothing(Mode::kNone,
                request.cancelled ? Cause::kCancelled : Cause::kNewRequest,
                out);
}

void Gate::DropBaseline() {
  if (baseline_) replaced_baselines_.Add(baseline_->message.baseline_digest);
  baseline_.reset();
}

// A baseline carries the request on when its sender is gone: it is taken over
// where there is none, and where its planner knew the current request and went
// on to another. A planner that never named the current request is only late.
bool Gate::Adopt(const BaselineEvent& event, Decisions& out) {
  if (event.request_id == request_.id) {
    answered_by_ = event.session;
    return true;
  }
  const bool moved_on = answered_by_ != 0 && answered_by_ == event.session;
  if (event.request_id == 0 || replaced_requests_.Has(event.request_id) ||
      (request_.id != 0 && !moved_on)) {
    return false;
  }
  Replace(Request{event.request_id, event.cancelled, event.start, event.goal},
          out);
  answered_by_ = event.session;
  return true;
}

// ---- Baselines ----

Decisions Gate::On(const BaselineEvent& event) {
  Decisions out;
  if (!Adopt(event, out)) {
    ++counters_.other_baselines;
    return out;
  }
  if (request_.cancelled) return out;
  if (!event.has_route) {
    DropBaseline();
    if (!deployed_.has_route() && deployed_.cause != Cause::kNoRoute) {
      DeployNothing(Mode::kNone, Cause::kNoRoute, out);
    }
    return out;
  }
  if (map_ == nullptr || event.map_id != map_id_) {
    ++counters_.other_baselines;
    return out;
  }
  const bool repeated =
      baseline_ &&
      baseline_->message.baseline_digest == event.baseline_digest &&
      baseline_->message.map_id == event.map_id &&
      baseline_->message.waypoints == event.waypoints;
  if (repeated) return out;
  DropBaseline();
  baseline_ = HeldBaseline{event, CheckBaseline(event)};
  if (!baseline_->check.feasible()) {
    OnBadBaseline(out);
  } else if (!deployed_.has_route() ||
             StrictlyCheaper(baseline_->check.cost, deployed_.cost)) {
    DeployBaseline(Cause::kNewBaseline, out);
  }
  return out;
}

RouteCheck Gate::CheckBaseline(const BaselineEvent& event) const {
  RouteCheck check;
  const std::int64_t digest =
      BaselineDigest(event.request_id, event.map_id, event.waypoints);
  if (digest != event.baseline_digest) {
    check.code = Code::kMalformedMessage;
    return check;
  }
  return CheckRoute(*map_, event.waypoints, request_.start, request_.goal,
                    kBusLimits);
}

// The deployed route stays while it is valid for this request and map; it was
// checked when one of the two last changed.
void Gate::OnBadBaseline(Decisions& out) {
  ++counters_.invalid_baselines;
  ReportBaseline(out);
  if (!deployed_.has_route() && deployed_.mode != Mode::kHold) {
    DeployNothing(Mode::kHold, Cause::kBaselineInvalid, out);
  }
}

void Gate::ReportBaseline(Decisions& out) {
  const BaselineEvent& message = baseline_->message;
  Verdict verdict;
  verdict.decision = ++decisions_;
  verdict.subject = Subject::kBaseline;
  verdict.request_id = message.request_id;
  verdict.map_id = map_id_;
  verdict.baseline_digest = message.baseline_digest;
  verdict.anchor.cell = request_.start;
  verdict.advisor = message.planner;
  verdict.advisor_session = message.session;
  verdict.code = baseline_->check.code;
  verdict.cost_to_beat = deployed_.cost;
  verdict.route_seq_before = deployed_.route_seq;
  verdict.fail_segment = baseline_->check.segment;
  verdict.fail_cell = baseline_->check.cell;
  out.emplace_back(std::move(verdict));
}

// ---- What is deployed ----

void Gate::Deploy(Deployed next, Decisions& out) {
  next.decision = ++decisions_;
  next.route_seq = deployed_.route_seq + 1;
  next.request_id = request_.id;
  next.start = request_.start;
  next.goal = request_.goal;
  next.map_id = map_id_;
  deployed_ = std::move(next);
  out.emplace_back(deployed_);
}

void Gate::DeployBaseline(Cause cause, Decisions& out) {
  TERRA_REQUIRE(baseline_ && baseline_->check.feasible());
  Deployed next;
  next.mode = Mode::kBaseline;
  next.cause = cause;
  next.baseline_digest = baseline_->message.baseline_digest;
  next.source = baseline_->message.planner;
  next.source_session = baseline_->message.session;
  next.waypoints = baseline_->message.waypoints;
  next.cost = baseline_->check.cost;
  next.baseline_cost = baseline_->check.cost;
  Deploy(std::move(next), out);
}

void Gate::DeployNothing(Mode mode, Cause cause, Decisions& out) {
  Deployed next;
  next.mode = mode;
  next.cause = cause;
  next.baseline_digest = baseline_ ? baseline_->message.baseline_digest : 0;
  Deploy(std::move(next), out);
}

// ---- Map updates ----

// One step on one snapshot: nothing is compared across two maps.
Decisions Gate::On(const MapEvent& event) {
  TERRA_REQUIRE(event.map != nullptr);
  Decisions out;
  if (map_ != nullptr && event.map_id == map_id_) return out;
  replaced_maps_.Add(map_id_);
  map_ = event.map;
  map_id_ = event.map_id;
  if (request_.id == 0 || request_.cancelled) return out;
  if (baseline_) {
    // Its message names the old map, so a repetition of it will not match; the
    // planner's next one will be another.
    baseline_->check = CheckRoute(*map_, baseline_->message.waypoints,
                                  request_.start, request_.goal, kBusLimits);
  }
  const bool baseline_ok = baseline_ && baseline_->check.feasible();
  if (baseline_ && !baseline_ok) {
    ++counters_.invalid_baselines;
    ReportBaseline(out);
  }
  if (deployed_.mode == Mode::kCandidate) {
    const RouteCheck check = CheckRoute(
        *map_, deployed_.waypoints, request_.start, request_.goal, kBusLimits);
    const bool cheaper =
        !baseline_ok || StrictlyCheaper(check.cost, baseline_->check.cost);
    if (check.feasible() && cheaper) {
      Deployed next = deployed_;
      next.cause = Cause::kMapUpdate;
      next.cost = check.cost;
      next.baseline_cost = baseline_ok ? baseline_->check.cost : kImpassable;
      Deploy(std::move(next), out);
    } else if (baseline_ok) {
      DeployBaseline(
          check.feasible() ? Cause::kRevertNotCheaper : Cause::kRevertBlocked,
          out);
    } else {
      DeployNothing(Mode::kHold, Cause::kRevertBlocked, out);
    }
  } else if (baseline_ok) {
    DeployBaseline(Cause::kMapUpdate, out);
  } else if (deployed_.has_route() || deployed_.mode == Mode::kHold) {
    DeployNothing(Mode::kHold, Cause::kBaselineInvalid, out);
  }
  return out;
}

// ---- Advice ----

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
  if (WasJudged(event)) {
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
  verdict.code = *key;
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

bool Gate::WasJudged(const AdviceEvent& event) {
  const AdviceKey key = {event.request_id, event.map_id,  event.baseline_digest,
                         event.session,    event.attempt, event.candidate};
  if (!judged_.insert(key).second) return true;
  judged_order_.push_back(key);
  if (judged_order_.size() > kRememberedAdvice) {
    judged_.erase(judged_order_.front());
    judged_order_.pop_front();
  }
  return false;
}

void Gate::Judge(const AdviceEvent& event, Verdict& verdict) const {
  verdict.baseline_cost = baseline_->check.cost;
  verdict.cost_to_beat = deployed_.cost;
  if (!baseline_->check.feasible()) {
    verdict.code = Code::kBaselineInvalid;
    return;
  }
  // Advice for a robot that moves is not taken yet: fail closed.
  if (event.anchor.index != 0) {
    verdict.code = Code::kLate;
    return;
  }
  switch (event.kind) {
    case AdviceKind::kRetain:
      verdict.code = Code::kRetained;
      return;
    case AdviceKind::kMalformed:
      verdict.code = Code::kParseError;
      return;
    case AdviceKind::kPropose:
      break;
    default:
      verdict.code = Code::kMalformedMessage;
      return;
  }
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

#include "verifier/gate.h"

#include <utility>

#include "terrain/digest.h"
#include "terrain/require.h"

namespace terra::verifier {

// ---- Requests ----

std::optional<Gate> Gate::GoOnFrom(const GateOptions& options,
                                   const GateState& state) {
  Gate gate(options);
  gate.requests_ = RequestRule::GoOnFrom(state.request, state.answered_by);
  gate.map_ = state.map;
  gate.map_id_ = state.map_id;
  gate.decisions_ = state.decisions;
  gate.deployed_ = state.deployed;
  const bool has_route = state.deployed.has_route();
  if ((state.baseline || has_route) && !state.map) return std::nullopt;
  if (has_route != !state.deployed.waypoints.empty()) return std::nullopt;
  if (has_route &&
      !CheckRoute(*state.map, state.deployed.waypoints, state.request.start,
                  state.request.goal, kBusLimits)
           .feasible()) {
    return std::nullopt;
  }
  if (!gate.driven_.FollowFrom(state.deployed.waypoints, state.place,
                               state.on_route)) {
    return std::nullopt;
  }
  if (state.baseline) {
    gate.baseline_ =
        HeldBaseline{*state.baseline, gate.CheckBaseline(*state.baseline)};
  }
  return gate;
}

Decisions Gate::On(const RequestEvent& event) {
  Decisions out;
  OnChange(requests_.OnRequest(
               {event.request_id, event.cancel, 0, event.start, event.goal}),
           out);
  return out;
}

// The route of another request leads elsewhere; that of a cancelled one,
// nowhere.
void Gate::OnChange(RequestRule::Change change, Decisions& out) {
  lookup_ =
      change == RequestRule::Change::kReplaced ? Lookup::kNew : Lookup::kNone;
  if (change != RequestRule::Change::kReplaced &&
      change != RequestRule::Change::kCancelled) {
    return;
  }
  DropBaseline();
  DeployNothing(Mode::kNone,
                request().cancelled ? Cause::kCancelled : Cause::kNewRequest,
                out);
}

// ---- Baselines ----

Decisions Gate::On(const BaselineEvent& event) {
  Decisions out;
  const RequestInForce carried{event.request_id, event.cancelled, 0,
                               event.start, event.goal};
  const RequestRule::Change change = requests_.OnAnswer(carried, event.session);
  OnChange(change, out);
  if (change == RequestRule::Change::kOther) {
    ++counters_.other_baselines;
    return out;
  }
  if (request().cancelled) return out;
  if (map_ == nullptr || event.map_id != map_id_) {
    ++counters_.other_baselines;
    return out;
  }
  if (!event.has_route) {
    OnNoRoute(out);
    return out;
  }
  if (Holds(event)) return out;
  DropBaseline();
  baseline_ = HeldBaseline{event, CheckBaseline(event)};
  if (!baseline_valid()) {
    OnBadBaseline(out);
  } else if (StrictlyCheaper(baseline_->check.cost, deployed_.cost)) {
    // A route that is not there costs infinity.
    DeployBaseline(Cause::kNewBaseline, out);
  }
  return out;
}

bool Gate::Holds(const BaselineEvent& event) const {
  return baseline_ &&
         baseline_->message.baseline_digest == event.baseline_digest &&
         baseline_->message.map_id == event.map_id &&
         baseline_->message.waypoints == event.waypoints;
}

void Gate::DropBaseline() {
  if (baseline_) replaced_baselines_.Add(baseline_->message.baseline_digest);
  baseline_.reset();
}

RouteCheck Gate::CheckBaseline(const BaselineEvent& event) const {
  RouteCheck check;
  const std::int64_t digest =
      BaselineDigest(event.request_id, event.map_id, event.waypoints);
  if (digest != event.baseline_digest || event.planner.size() > kMaxNameBytes) {
    check.code = Code::kMalformedMessage;
    return check;
  }
  return CheckRoute(*map_, event.waypoints, request().start, request().goal,
                    kBusLimits);
}

// The deployed route, if any, is still valid: it was checked when map or
// request last changed. Said once per map, not with each repetition.
void Gate::OnNoRoute(Decisions& out) {
  DropBaseline();
  const bool said =
      deployed_.cause == Cause::kNoRoute && deployed_.map_id == map_id_;
  if (!deployed_.has_route() && !said) {
    DeployNothing(Mode::kNone, Cause::kNoRoute, out);
  }
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
  verdict.anchor.cell = request().start;
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
  next.request_id = request().request_id;
  next.start = request().start;
  next.goal = request().goal;
  next.map_id = map_id_;
  deployed_ = std::move(next);
  driven_.Follow(deployed_.waypoints);
  out.emplace_back(deployed_);
}

void Gate::DeployBaseline(Cause cause, Decisions& out) {
  TERRA_REQUIRE(baseline_valid());
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
  lookup_ = Lookup::kNone;
  if (map_ != nullptr && event.map_id == map_id_) return out;
  replaced_maps_.Add(map_id_);
  map_ = event.map;
  map_id_ = event.map_id;
  RecheckBaseline(out);
  RecheckDeployed(out);
  return out;
}

// The baseline's message names the old map, so a repetition of it will not
// match; the planner's next one will be another. One that was not what its
// digest says stays refused.
void Gate::RecheckBaseline(Decisions& out) {
  if (!baseline_ || baseline_->check.code == Code::kMalformedMessage) return;
  baseline_->check = CheckRoute(*map_, baseline_->message.waypoints,
                                request().start, request().goal, kBusLimits);
  if (!baseline_valid()) {
    ++counters_.invalid_baselines;
    ReportBaseline(out);
  }
}

void Gate::RecheckDeployed(Decisions& out) {
  if (!deployed_.has_route()) {
    if (baseline_valid()) {
      DeployBaseline(Cause::kMapUpdate, out);
    } else if (deployed_.mode == Mode::kHold) {
      DeployNothing(Mode::kHold, Cause::kBaselineInvalid, out);
    }
    return;
  }
  const bool candidate = deployed_.mode == Mode::kCandidate;
  const RouteCheck check = CheckRoute(
      *map_, deployed_.waypoints, request().start, request().goal, kBusLimits);
  if (!baseline_valid()) {
    if (check.feasible()) {
      KeepOnNewMap(check.cost, out);
    } else {
      DeployNothing(Mode::kHold,
                    candidate ? Cause::kRevertBlocked : Cause::kBaselineInvalid,
                    out);
    }
    return;
  }
  // A candidate has to be strictly cheaper again; a deployed baseline only not
  // dearer than the one held now, which may be itself. A route that is blocked
  // costs infinity and is neither.
  const double baseline_cost = baseline_->check.cost;
  const bool worth_it = candidate ? StrictlyCheaper(check.cost, baseline_cost)
                                  : !StrictlyCheaper(baseline_cost, check.cost);
  if (worth_it) {
    KeepOnNewMap(check.cost, out);
  } else {
    DeployBaseline(
        check.feasible() ? Cause::kRevertNotCheaper : Cause::kRevertBlocked,
        out);
  }
}

// A candidate is named with the baseline held, and what that costs on this map:
// infinity where it is blocked. One that is not what its digest says would be
// mistaken for another, so none is named then.
void Gate::KeepOnNewMap(double cost, Decisions& out) {
  Deployed next = deployed_;
  next.cause = Cause::kMapUpdate;
  next.cost = cost;
  if (next.mode == Mode::kBaseline) {
    next.baseline_cost = cost;
  } else if (baseline_ && baseline_->check.code != Code::kMalformedMessage) {
    next.baseline_digest = baseline_->message.baseline_digest;
    next.baseline_cost = baseline_->check.cost;
  } else {
    next.baseline_digest = 0;
    next.baseline_cost = kImpassable;
  }
  Deploy(std::move(next), out);
}

}  // namespace terra::verifier

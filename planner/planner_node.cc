#include "planner/planner_node.h"

#include <chrono>
#include <limits>
#include <utility>

#include "bus/codec.h"
#include "terrain/digest.h"
#include "terrain/route_cost.h"

namespace terra::planner {
namespace {

using terra_msg::baseline_t;

// A process that just started gets its map within this time; before that there
// is nothing to complain of.
constexpr bus::Duration kMapPatience = std::chrono::seconds(2);
// A gate on hold asks for a new plan; on an unchanged map it gets one this
// often.
constexpr bus::Duration kReplanPause = std::chrono::seconds(1);
// A gate answers a new baseline well within this time; where it does not, the
// baseline was lost or its answer was.
constexpr bus::Duration kAnswerTime = std::chrono::milliseconds(10);
constexpr int kQuickRepeats = 3;

std::int8_t StatusOf(SearchStatus status) {
  switch (status) {
    case SearchStatus::kFound:
      return baseline_t::STATUS_OK;
    case SearchStatus::kNoRoute:
      return baseline_t::STATUS_NO_ROUTE;
    case SearchStatus::kStartOutside:
      return baseline_t::STATUS_START_OUTSIDE;
    case SearchStatus::kGoalOutside:
      return baseline_t::STATUS_GOAL_OUTSIDE;
    case SearchStatus::kStartBlocked:
      return baseline_t::STATUS_START_BLOCKED;
    case SearchStatus::kGoalBlocked:
      return baseline_t::STATUS_GOAL_BLOCKED;
  }
  return baseline_t::STATUS_NONE;
}

bool FitsTheBus(const TerrainMap& map, const Route& route) {
  return route.size() <= bus::kMaxWaypoints &&
         WalkRoute(map, route, bus::kMaxSteps).fault != RouteFault::kWorkLimit;
}

}  // namespace

PlannerNode::PlannerNode(std::string name, PlanFunction plan, bus::Outbox& out)
    : name_(std::move(name)), plan_(std::move(plan)), out_(out), map_(out) {
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time now) {
    if (map_.OnHeader(message, now)) Plan(now);
  });
  Listen<terra_msg::map_tile_t>([this](const auto& message, bus::Time now) {
    if (map_.OnTiles(message, now)) Plan(now);
  });
  Listen<terra_msg::plan_request_t>([this](const auto& message, bus::Time now) {
    if (const auto asked = bus::RequestOf(message); !asked) {
      CountMalformed(bus::Channel::kPlanRequest, asked.error().message);
    }
    if (requests_.OnRequest(message)) OnRequestChanged(now);
  });
  Listen<terra_msg::deployed_t>([this](const auto& message, bus::Time now) {
    OnDeployed(message, now);
  });
  Listen<terra_msg::verdict_t>([this](const auto& message, bus::Time) {
    if (message.subject != terra_msg::verdict_t::SUBJECT_BASELINE) return;
    OnAnswer(message.request_id, message.map_id, message.baseline_digest);
  });
}

void PlannerNode::OnAnswer(std::int64_t request_id, std::int64_t map_id,
                           std::int64_t baseline_digest) {
  if (has_baseline_ && request_id == baseline_.request_id &&
      map_id == baseline_.map_id &&
      baseline_digest == baseline_.baseline_digest) {
    unanswered_at_ = bus::kNever;
  }
}

void PlannerNode::SayAgain(bus::Time now) {
  out_.Send(baseline_);
  repeat_.Postpone(now);
  ++all_quick_repeats_;
  unanswered_at_ =
      ++quick_repeats_ < kQuickRepeats ? now + kAnswerTime : bus::kNever;
}

void PlannerNode::OnDeployed(const terra_msg::deployed_t& message,
                             bus::Time now) {
  if (!gate_.Accept(message.session, message.seq)) return;
  OnAnswer(message.request_id, message.map_id, message.baseline_digest);
  RequestInForce carried;
  carried.request_id = message.request_id;
  carried.cancelled = message.cause == terra_msg::deployed_t::CAUSE_CANCELLED;
  carried.start = Cell{message.start_x, message.start_y};
  carried.goal = Cell{message.goal_x, message.goal_y};
  if (requests_.OnAnswer(carried, message.session)) {
    OnRequestChanged(now);
    return;
  }
  // A gate on hold asks for a new plan.
  const bool about_ours = has_baseline_ &&
                          message.request_id == baseline_.request_id &&
                          message.map_id == baseline_.map_id;
  if (message.mode == terra_msg::deployed_t::MODE_HOLD && about_ours &&
      now >= planned_at_ + kReplanPause) {
    Plan(now);
  }
}

void PlannerNode::OnRequestChanged(bus::Time now) {
  has_baseline_ = false;
  unanswered_at_ = bus::kNever;
  no_map_at_ = map_.map() ? bus::kNever : now + kMapPatience;
  Plan(now);
}

void PlannerNode::PlanWith(PlanFunction plan, bus::Time now) {
  plan_ = std::move(plan);
  Plan(now);
}

void PlannerNode::Plan(bus::Time now) {
  const RequestInForce& request = requests_.current();
  if (!request.any() || (!map_.map() && now < no_map_at_)) return;
  FillBaseline(request);
  if (request.cancelled) {
    baseline_.status = baseline_t::STATUS_CANCELLED;
  } else if (!map_.map()) {
    baseline_.status = baseline_t::STATUS_NO_MAP;
  } else if (request.map_id != 0 && request.map_id != map_.map_id()) {
    baseline_.status = baseline_t::STATUS_OTHER_MAP;
  } else {
    const auto begin = bus::Clock::now();
    FillRoute(plan_(map_.map()->map, request.start, request.goal));
    baseline_.search_us = std::chrono::duration_cast<std::chrono::microseconds>(
                              bus::Clock::now() - begin)
                              .count();
  }
  no_map_at_ = bus::kNever;
  planned_at_ = now;
  ++plans_;
  has_baseline_ = true;
  out_.Send(baseline_);
  repeat_.Postpone(now);
  // Only a route has an answer that names it.
  quick_repeats_ = 0;
  unanswered_at_ = baseline_.status == baseline_t::STATUS_OK ? now + kAnswerTime
                                                             : bus::kNever;
}

void PlannerNode::FillBaseline(const RequestInForce& request) {
  baseline_ = baseline_t{};
  baseline_.request_id = request.request_id;
  baseline_.start_x = request.start.x;
  baseline_.start_y = request.start.y;
  baseline_.goal_x = request.goal.x;
  baseline_.goal_y = request.goal.y;
  baseline_.map_id = map_.map_id();
  baseline_.planner = name_;
  baseline_.baseline_cost = std::numeric_limits<double>::quiet_NaN();
}

void PlannerNode::FillRoute(const LatticePlan& plan) {
  baseline_.status = StatusOf(plan.status);
  baseline_.nodes_expanded = plan.expanded;
  baseline_.edges_costed = plan.edges_costed;
  if (!plan.found()) return;
  if (!FitsTheBus(map_.map()->map, plan.waypoints)) {
    baseline_.status = baseline_t::STATUS_TOO_LONG;
    return;
  }
  bus::SetWaypoints(baseline_, plan.waypoints);
  baseline_.baseline_cost = plan.cost;
  baseline_.baseline_digest =
      BaselineDigest(baseline_.request_id, baseline_.map_id, plan.waypoints);
}

bus::Time PlannerNode::Advance(bus::Time now) {
  if (now >= no_map_at_) Plan(now);
  if (has_baseline_ && now >= unanswered_at_) SayAgain(now);
  if (has_baseline_ && repeat_.Due(now)) out_.Send(baseline_);
  const bus::Time repeat = has_baseline_ ? repeat_.next() : bus::kNever;
  return std::min({map_.Advance(now), repeat, unanswered_at_, no_map_at_});
}

std::string PlannerNode::state() const {
  if (!map_.map()) return map_.state();
  if (!requests_.current().any()) return "ready, no request yet";
  return "ready";
}

std::string PlannerNode::last_error() const {
  return map_.last_error().empty() ? Node::last_error() : map_.last_error();
}

void PlannerNode::AddCounters(bus::Counters& counters) const {
  Node::AddCounters(counters);
  counters.emplace_back("plans", plans_);
  counters.emplace_back("quick_repeats", all_quick_repeats_);
  counters.emplace_back(
      "lost", static_cast<std::int64_t>(map_.sender().lost() + gate_.lost()));
  counters.emplace_back("from_replaced_map_server",
                        map_.sender().from_replaced());
  counters.emplace_back("from_replaced_gate", gate_.from_replaced());
}

}  // namespace terra::planner

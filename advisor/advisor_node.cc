#include "advisor/advisor_node.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "advisor/advice_codec.h"
#include "bus/codec.h"
#include "terrain/route_cost.h"

namespace terra::advisor {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::pose_t;
using terra_msg::verdict_t;

// Advice that came too late is not worked out again sooner, so that two views
// of what is deployed make no storm.
constexpr bus::Duration kAgainAfter = std::chrono::seconds(1);

double Seconds(bus::Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

AdvisorNode::AdvisorNode(std::string name, std::unique_ptr<Backend> backend,
                         bus::Outbox& out, std::function<void()> wake)
    : name_(std::move(name)),
      out_(out),
      map_(out),
      answer_time_(backend->usual_seconds()),
      worker_(std::move(backend), std::move(wake)) {
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time now) {
    if (message.cell_size_m > 0) cell_size_m_ = message.cell_size_m;
    if (map_.OnHeader(message, now)) Begin(now);
  });
  Listen<terra_msg::map_tile_t>([this](const auto& message, bus::Time now) {
    if (map_.OnTiles(message, now)) Begin(now);
  });
  Listen<baseline_t>([this](const auto& message, bus::Time now) {
    OnBaseline(message, now);
  });
  Listen<deployed_t>([this](const auto& message, bus::Time now) {
    OnDeployed(message, now);
  });
  Listen<pose_t>([this](const auto& message, bus::Time now) {
    OnPose(message, now);
  });
  Listen<verdict_t>([this](const auto& message, bus::Time now) {
    OnVerdict(message, now);
  });
}

void AdvisorNode::OnBaseline(const baseline_t& message, bus::Time now) {
  if (!planner_.Accept(message.session, message.seq)) return;
  const bool same = message.request_id == baseline_.request_id &&
                    message.map_id == baseline_.map_id &&
                    message.status == baseline_.status &&
                    message.baseline_digest == baseline_.baseline_digest;
  if (same) return;
  baseline_ = message;
  Begin(now);
}

void AdvisorNode::OnDeployed(const deployed_t& message, bus::Time now) {
  if (!gate_.Accept(message.session, message.seq)) return;
  anchors_.OnDeployed({message.session, message.route_seq, message.request_id,
                       message.map_id, bus::WaypointsOf(message)});
  FollowRobot(now);
}

void AdvisorNode::OnPose(const pose_t& message, bus::Time now) {
  anchors_.OnPose(message.deployed_session, message.deployed_route_seq,
                  {message.pose_x, message.pose_y},
                  message.speed_mps / cell_size_m_,
                  Seconds(now.time_since_epoch()));
  FollowRobot(now);
}

void AdvisorNode::OnVerdict(const verdict_t& message, bus::Time now) {
  const bool own =
      message.subject == verdict_t::SUBJECT_ADVICE &&
      message.advisor == name_ && message.advisor_session == out_.session() &&
      message.attempt == jobs_ && message.anchor_session == anchor_.session &&
      message.anchor_route_seq == anchor_.route_seq &&
      message.anchor_index == anchor_.index;
  if (!own || message.code != verdict_t::CODE_LATE) return;
  if (work_ != Work::kAnswered || again_at_ != bus::kNever) return;
  again_at_ = now + kAgainAfter;
}

// The robot may have become ready for a proposal, or passed its anchor.
void AdvisorNode::FollowRobot(bus::Time now) {
  if (work_ == Work::kWaiting) {
    Begin(now);
  } else if (work_ == Work::kRunning &&
             !anchors_.InForce(anchor_, baseline_.request_id)) {
    ++passed_;
    answer_time_.AtLeast(Seconds(now - began_));
    Begin(now);
  }
}

// Starts on the baseline in hand, if there is a map and a route to improve.
void AdvisorNode::Begin(bus::Time now) {
  worker_.Cancel();
  current_.clear();
  work_ = Work::kNone;
  again_at_ = bus::kNever;
  if (!map_.map() || baseline_.map_id != map_.map_id() ||
      baseline_.status != baseline_t::STATUS_OK) {
    return;
  }
  const auto anchor = anchors_.Choose(
      {baseline_.request_id, baseline_.map_id,
       Cell{baseline_.start_x, baseline_.start_y}, answer_time_.seconds(),
       Seconds(now.time_since_epoch())});
  if (!anchor) {
    work_ = Work::kWaiting;
    return;
  }
  StartFrom(*anchor, now);
}

void AdvisorNode::StartFrom(const Anchor& anchor, bus::Time now) {
  const bus::MapPtr& map = map_.map();
  Route route = anchor.index == 0 ? bus::WaypointsOf(baseline_)
                                  : anchors_.RouteFrom(anchor);
  // The gate says what is wrong with a route that is none or too long.
  if (route.size() < 2 || route.size() > bus::kMaxWaypoints) return;
  const double cost = WalkRoute(map->map, route, bus::kMaxSteps).cost;
  if (cost == kImpassable) return;  // the gate will say why
  work_ = Work::kRunning;
  anchor_ = anchor;
  began_ = now;
  worker_.Start({++jobs_,
                 {map, &map->map},
                 map->map_id,
                 baseline_.request_id,
                 baseline_.baseline_digest,
                 anchor,
                 Cell{baseline_.goal_x, baseline_.goal_y},
                 std::move(route),
                 cost});
}

void AdvisorNode::Publish(const AdviceWorker::Finished& done, bus::Time now) {
  ++answers_;
  work_ = Work::kAnswered;
  answer_time_.Add(Seconds(now - began_));
  if (done.answer.kind == AnswerKind::kFailed) ++failures_;
  if (!done.answer.error.empty()) last_error_ = done.answer.error;
  current_ =
      ToMessages({name_, worker_.backend().method(), worker_.backend().name()},
                 done.job, done.answer);
  for (advice_t& message : current_) out_.Send(message);
  repeat_.Postpone(now);
}

bus::Time AdvisorNode::Advance(bus::Time now) {
  if (const auto done = worker_.Take()) Publish(*done, now);
  if (!current_.empty() && repeat_.Due(now)) {
    for (advice_t& message : current_) out_.Send(message);
  }
  if (now >= again_at_) Begin(now);
  const bus::Time repeat = current_.empty() ? bus::kNever : repeat_.next();
  return std::min({map_.Advance(now), repeat, again_at_});
}

std::string AdvisorNode::state() const {
  if (!map_.map()) return map_.state();
  const std::string special = worker_.backend().figures().state;
  if (!special.empty()) return special;
  if (work_ == Work::kWaiting) return "ready: waiting for the robot";
  return worker_.busy() ? "working" : "ready";
}

std::string AdvisorNode::last_error() const {
  if (!last_error_.empty()) return last_error_;
  return map_.last_error().empty() ? Node::last_error() : map_.last_error();
}

void AdvisorNode::AddCounters(bus::Counters& counters) const {
  Node::AddCounters(counters);
  counters.emplace_back("jobs", jobs_);
  counters.emplace_back("answers", answers_);
  counters.emplace_back("failures", failures_);
  counters.emplace_back("anchor_passed", passed_);
  counters.emplace_back("queue", worker_.busy() ? 1 : 0);
  for (auto& counter : worker_.backend().figures().counters) {
    counters.push_back(std::move(counter));
  }
  counters.emplace_back("from_replaced_planner", planner_.from_replaced());
}

}  // namespace terra::advisor

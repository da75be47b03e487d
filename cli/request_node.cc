#include "cli/request_node.h"

#include <algorithm>

namespace terra::cli {
namespace {

using terra_msg::baseline_t;
using terra_msg::deployed_t;

// A picture wants the map; no set takes longer to send one.
constexpr bus::Duration kMapPatience = std::chrono::seconds(20);
// A set that was just started is in service within this time.
constexpr bus::Duration kBaselinePatience = std::chrono::seconds(2);
// A map file that was edited is offered within 2 s.
constexpr bus::Duration kMapEditPatience = std::chrono::milliseconds(2'500);
// Two heartbeats, of which the second surely follows the answer.
constexpr bus::Duration kReasonPatience = std::chrono::milliseconds(2'500);
constexpr std::size_t kMaxKeptVerdicts = 1'000;

}  // namespace

RequestNode::RequestNode(const RequestPlan& plan, bus::Outbox& out)
    : plan_(plan), out_(out), map_(out) {
  request_.request_id = plan.request_id;
  request_.action = terra_msg::plan_request_t::ACTION_GO;
  request_.map_id = plan.map_id;
  request_.start_x = plan.start.x;
  request_.start_y = plan.start.y;
  request_.goal_x = plan.goal.x;
  request_.goal_y = plan.goal.y;
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time now) {
    OnHeader(message, now);
  });
  Listen<terra_msg::map_tile_t>([this](const auto& message, bus::Time now) {
    map_.OnTiles(message, now);
  });
  Listen<baseline_t>([this](const auto& message, bus::Time now) {
    OnBaseline(message, now);
  });
  Listen<deployed_t>([this](const auto& message, bus::Time now) {
    OnDeployed(message, now);
  });
  Listen<terra_msg::verdict_t>([this](const auto& message, bus::Time now) {
    OnVerdict(message, now);
  });
  Listen<terra_msg::status_t>([this](const auto& message, bus::Time) {
    if (baseline_) advisors_.OnStatus(message);
  });
}

void RequestNode::OnHeader(const terra_msg::map_header_t& message,
                           bus::Time now) {
  if (map_server_.Accept(message.session, message.seq)) {
    offered_map_id_ = message.map_id;
  }
  if (plan_.want_map) map_.OnHeader(message, now);
}

void RequestNode::OnBaseline(const baseline_t& message, bus::Time now) {
  if (!planner_.Accept(message.session, message.seq) ||
      message.request_id != plan_.request_id) {
    return;
  }
  const bool is_first_route =
      message.status == baseline_t::STATUS_OK &&
      (!baseline_ || baseline_->status != baseline_t::STATUS_OK);
  if (!baseline_ms_ || is_first_route) {
    baseline_ms_ = MillisecondsSinceStart(now);
  }
  if (!baseline_ || baseline_->status != message.status ||
      baseline_->map_id != message.map_id) {
    baseline_since_ = now;
  }
  baseline_ = message;
}

void RequestNode::OnDeployed(const deployed_t& message, bus::Time now) {
  if (!gate_.Accept(message.session, message.seq) ||
      message.request_id != plan_.request_id) {
    return;
  }
  deployed_ = message;
  if (HasRoute() && !deployed_ms_) deployed_ms_ = MillisecondsSinceStart(now);
  if (message.mode == deployed_t::MODE_CANDIDATE && !refined_ms_) {
    refined_ms_ = MillisecondsSinceStart(now);
  }
}

void RequestNode::OnVerdict(const terra_msg::verdict_t& message,
                            bus::Time now) {
  if (message.request_id != plan_.request_id ||
      verdicts_.size() >= kMaxKeptVerdicts) {
    return;
  }
  verdicts_.push_back(message);
  if (message.code == terra_msg::verdict_t::CODE_PARSE_ERROR) {
    advisors_ = {};  // What was heard before is not of this answer.
    reason_until_ = now + kReasonPatience;
  }
}

bool RequestNode::HasRoute() const {
  return deployed_ && (deployed_->mode == deployed_t::MODE_BASELINE ||
                       deployed_->mode == deployed_t::MODE_CANDIDATE);
}

bool RequestNode::Answered() const {
  return baseline_ && deployed_;
}

bool RequestNode::advised() const {
  return refined_ms_.has_value() ||
         std::any_of(verdicts_.begin(), verdicts_.end(), [](const auto& each) {
           return each.subject == terra_msg::verdict_t::SUBJECT_ADVICE;
         });
}

// Was an answer judged and not taken, and told why, if that can be told?
bool RequestNode::Refused(bus::Time now) const {
  const auto untold = [&](const auto& verdict) {
    return verdict.code == terra_msg::verdict_t::CODE_PARSE_ERROR &&
           now < reason_until_ && advisors_.ErrorOf(verdict.advisor).empty();
  };
  return std::any_of(
      verdicts_.begin(), verdicts_.end(), [&](const auto& verdict) {
        return verdict.subject == terra_msg::verdict_t::SUBJECT_ADVICE &&
               verdict.code != terra_msg::verdict_t::CODE_ACCEPTED &&
               !untold(verdict);
      });
}

// Nothing more is to be waited for.
bool RequestNode::Settled(bus::Time now) const {
  if (!Answered()) return false;
  if (baseline_->status == baseline_t::STATUS_CANCELLED) return true;
  if (baseline_->status != baseline_t::STATUS_OK) {
    return offered_map_id_ != 0 && baseline_->map_id == offered_map_id_ &&
           now >= baseline_since_ + kMapEditPatience;
  }
  const bool on_old_map =
      offered_map_id_ != 0 && deployed_->map_id != offered_map_id_;
  return HasRoute() && !on_old_map &&
         (refined_ms_.has_value() || Refused(now) || advisors_.AllGaveUp());
}

bool RequestNode::TimeIsUp(bus::Time now) const {
  const bool has_answer =
      HasRoute() || (baseline_ && baseline_->status != baseline_t::STATUS_OK);
  return now >= started_at_ + plan_.wait &&
         (has_answer || now >= started_at_ + kBaselinePatience);
}

double RequestNode::MillisecondsSinceStart(bus::Time now) const {
  return std::chrono::duration<double, std::milli>(now - started_at_).count();
}

bus::Time RequestNode::Advance(bus::Time now) {
  if (started_at_ == bus::kNever) started_at_ = now;
  if (repeat_.Due(now) && (!Answered() || plan_.keep)) out_.Send(request_);
  const bool map_is_here =
      !plan_.want_map || !HasRoute() || map_.map() != nullptr;
  const bool map_time_is_up = now >= started_at_ + plan_.wait + kMapPatience;
  if (!plan_.keep && (Settled(now) || TimeIsUp(now)) &&
      (map_is_here || map_time_is_up)) {
    done_ = true;
  }
  const bus::Time map_due = plan_.want_map ? map_.Advance(now) : bus::kNever;
  return std::min(repeat_.next(), map_due);
}

}  // namespace terra::cli

#include "bus/request_tracker.h"

#include <algorithm>

namespace terra::bus {
namespace {

constexpr std::size_t kRememberedIds = 64;

}  // namespace

bool RequestTracker::OnRequest(const terra_msg::plan_request_t& message) {
  const bool cancel =
      message.action == terra_msg::plan_request_t::ACTION_CANCEL;
  const bool go = message.action == terra_msg::plan_request_t::ACTION_GO;
  if (message.request_id == 0 || !(go || cancel)) return false;
  if (message.request_id == current_.request_id) {
    if (go || current_.cancelled) return false;
    current_.cancelled = true;
    return true;
  }
  if (WasReplaced(message.request_id)) return false;
  if (cancel) {  // of a request that never came: it must not start later
    Remember(message.request_id);
    return false;
  }
  Replace(RequestInForce{message.request_id, false, message.map_id,
                         Cell{message.start_x, message.start_y},
                         Cell{message.goal_x, message.goal_y}});
  return true;
}

bool RequestTracker::OnAnswer(const RequestInForce& carried,
                              std::int64_t sender_session) {
  if (!carried.any()) return false;
  if (carried.request_id == current_.request_id) {
    answered_by_ = sender_session;
    return false;
  }
  const bool moved_on = answered_by_ == sender_session;
  if (WasReplaced(carried.request_id) || (current_.any() && !moved_on)) {
    return false;
  }
  Replace(carried);
  answered_by_ = sender_session;
  return true;
}

bool RequestTracker::WasReplaced(std::int64_t request_id) const {
  return std::find(replaced_.begin(), replaced_.end(), request_id) !=
         replaced_.end();
}

void RequestTracker::Replace(const RequestInForce& request) {
  if (current_.any()) Remember(current_.request_id);
  current_ = request;
  answered_by_ = 0;
}

void RequestTracker::Remember(std::int64_t request_id) {
  replaced_.push_back(request_id);
  if (replaced_.size() > kRememberedIds) replaced_.pop_front();
}

}  // namespace terra::bus

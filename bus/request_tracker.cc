#include "bus/request_tracker.h"

namespace terra::bus {
namespace {

bool IsNew(RequestRule::Change change) {
  return change == RequestRule::Change::kReplaced ||
         change == RequestRule::Change::kCancelled;
}

}  // namespace

std::optional<RequestInForce> RequestOf(
    const terra_msg::plan_request_t& message) {
  const bool cancel =
      message.action == terra_msg::plan_request_t::ACTION_CANCEL;
  if (!cancel && message.action != terra_msg::plan_request_t::ACTION_GO) {
    return std::nullopt;
  }
  return RequestInForce{message.request_id, cancel, message.map_id,
                        Cell{message.start_x, message.start_y},
                        Cell{message.goal_x, message.goal_y}};
}

bool RequestTracker::OnRequest(const terra_msg::plan_request_t& message) {
  const std::optional<RequestInForce> asked = RequestOf(message);
  return asked && IsNew(rule_.OnRequest(*asked));
}

bool RequestTracker::OnAnswer(const RequestInForce& carried,
                              std::int64_t sender_session) {
  return IsNew(rule_.OnAnswer(carried, sender_session));
}

}  // namespace terra::bus

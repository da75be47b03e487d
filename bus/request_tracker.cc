#include "bus/request_tracker.h"

#include <string>

namespace terra::bus {
namespace {

bool IsNew(RequestRule::Change change) {
  return change == RequestRule::Change::kReplaced ||
         change == RequestRule::Change::kCancelled;
}

}  // namespace

Result<RequestInForce> RequestOf(const terra_msg::plan_request_t& message) {
  const bool cancel =
      message.action == terra_msg::plan_request_t::ACTION_CANCEL;
  if (!cancel && message.action != terra_msg::plan_request_t::ACTION_GO) {
    return Error{ErrorCode::kInvalid, "action " +
                                          std::to_string(message.action) +
                                          " is neither go (1) nor cancel (2)"};
  }
  if (message.request_id == 0) {
    return Error{ErrorCode::kInvalid, "request_id 0 names no request"};
  }
  return RequestInForce{message.request_id, cancel, message.map_id,
                        Cell{message.start_x, message.start_y},
                        Cell{message.goal_x, message.goal_y}};
}

bool RequestTracker::OnRequest(const terra_msg::plan_request_t& message) {
  const Result<RequestInForce> asked = RequestOf(message);
  return asked && IsNew(rule_.OnRequest(*asked));
}

bool RequestTracker::OnAnswer(const RequestInForce& carried,
                              std::int64_t sender_session) {
  return IsNew(rule_.OnAnswer(carried, sender_session));
}

}  // namespace terra::bus

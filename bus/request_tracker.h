#pragma once

#include <cstdint>

#include "bus/messages.h"
#include "terrain/request_in_force.h"
#include "terrain/result.h"

namespace terra::bus {

/// What a PLAN_REQUEST asks for, `cancelled` for a cancel.
/// Errors: no request_id, or an action that is none.
Result<RequestInForce> RequestOf(const terra_msg::plan_request_t& message);

/// Keeps the request in force over restarts of whoever sent it: RequestRule,
/// for messages.
/// Threads: one.
class RequestTracker {
 public:
  /// Each returns true when current() changed.
  bool OnRequest(const terra_msg::plan_request_t& message);
  bool OnAnswer(const RequestInForce& carried, std::int64_t sender_session);

  const RequestInForce& current() const { return rule_.current(); }

 private:
  RequestRule rule_;
};

}  // namespace terra::bus

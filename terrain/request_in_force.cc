#include "terrain/request_in_force.h"

#include <algorithm>

namespace terra {

void ReplacedIds::Add(std::int64_t id) {
  if (id == 0 || Has(id)) return;
  ids_.push_back(id);
  ++num_added_;
  if (ids_.size() > capacity_) ids_.pop_front();
}

bool ReplacedIds::Has(std::int64_t id) const {
  return std::find(ids_.begin(), ids_.end(), id) != ids_.end();
}

RequestRule RequestRule::GoOnFrom(const RequestInForce& current,
                                  std::int64_t answered_by) {
  RequestRule rule;
  rule.current_ = current;
  rule.answered_by_ = answered_by;
  return rule;
}

RequestRule::Change RequestRule::OnRequest(const RequestInForce& asked) {
  if (!asked.any()) return Change::kOther;
  if (asked.request_id == current_.request_id) {
    return asked.cancelled ? Cancel() : Change::kSame;
  }
  if (WasReplaced(asked.request_id)) return Change::kOther;
  if (asked.cancelled) {
    // Of a request that never came: it must not start later.
    replaced_.Add(asked.request_id);
    return Change::kOther;
  }
  return Replace(asked);
}

RequestRule::Change RequestRule::OnAnswer(const RequestInForce& carried,
                                          std::int64_t session) {
  if (!carried.any()) return Change::kOther;
  if (carried.request_id == current_.request_id) {
    answered_by_ = session;
    return carried.cancelled ? Cancel() : Change::kSame;
  }
  const bool moved_on = session != 0 && session == answered_by_;
  if (WasReplaced(carried.request_id) || (current_.any() && !moved_on)) {
    return Change::kOther;
  }
  Replace(carried);
  answered_by_ = session;
  return Change::kReplaced;
}

RequestRule::Change RequestRule::Cancel() {
  if (current_.cancelled) return Change::kSame;
  current_.cancelled = true;
  return Change::kCancelled;
}

RequestRule::Change RequestRule::Replace(const RequestInForce& request) {
  replaced_.Add(current_.request_id);
  current_ = request;
  answered_by_ = 0;
  return Change::kReplaced;
}

}  // namespace terra

#include "verifier/gate_memory.h"

#include <algorithm>

namespace terra::verifier {

void ReplacedIds::Add(std::int64_t id) {
  if (id == 0 || Has(id)) return;
  ids_.push_back(id);
  if (ids_.size() > capacity_) ids_.pop_front();
}

bool ReplacedIds::Has(std::int64_t id) const {
  return std::find(ids_.begin(), ids_.end(), id) != ids_.end();
}

bool JudgedAdvice::Add(const AdviceEvent& event) {
  const Key key = {event.request_id, event.map_id,  event.baseline_digest,
                   event.session,    event.attempt, event.candidate};
  const auto known = known_.find(key);
  if (known != known_.end()) {
    by_age_.splice(by_age_.end(), by_age_, known->second);
    return false;
  }
  known_.emplace(key, by_age_.insert(by_age_.end(), key));
  if (by_age_.size() > capacity_) {
    known_.erase(by_age_.front());
    by_age_.pop_front();
  }
  return true;
}

}  // namespace terra::verifier

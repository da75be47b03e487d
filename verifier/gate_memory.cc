#include "verifier/gate_memory.h"

namespace terra::verifier {

bool JudgedAdvice::Add(const AdviceEvent& event) {
  const Key key = {event.request_id, event.map_id,  event.baseline_digest,
                   event.session,    event.attempt, event.candidate};
  const auto [known, is_new] = known_.try_emplace(key);
  if (!is_new) by_age_.erase(known->second);
  known->second = ++heard_;
  by_age_.emplace(heard_, key);
  if (by_age_.size() > capacity_) {
    known_.erase(by_age_.begin()->second);
    by_age_.erase(by_age_.begin());
  }
  return is_new;
}

}  // namespace terra::verifier

#include "verifier/gate_memory.h"

#include <span>
#include <vector>

#include "terrain/digest.h"

namespace terra::verifier {
namespace {

// What the advice says, beside what names it.
std::int64_t ContentDigest(const AdviceEvent& event) {
  std::vector<std::int64_t> words = {
      static_cast<std::int64_t>(event.kind),
      event.anchor.session,
      event.anchor.route_seq,
      event.anchor.index,
      event.anchor.cell.x,
      event.anchor.cell.y,
      BytesDigest({reinterpret_cast<const std::uint8_t*>(event.advisor.data()),
                   event.advisor.size()})};
  words.reserve(words.size() + 2 * event.waypoints.size());
  for (const Cell cell : event.waypoints) {
    words.push_back(cell.x);
    words.push_back(cell.y);
  }
  return BytesDigest({reinterpret_cast<const std::uint8_t*>(words.data()),
                      words.size() * sizeof(words[0])});
}

}  // namespace

JudgedAdvice::Key JudgedAdvice::KeyOf(const AdviceEvent& event) {
  return {event.request_id,    event.map_id,  event.baseline_digest,
          event.session,       event.attempt, event.candidate,
          ContentDigest(event)};
}

bool JudgedAdvice::Has(const AdviceEvent& event) const {
  return known_.contains(KeyOf(event));
}

bool JudgedAdvice::Add(const AdviceEvent& event) {
  const Key key = KeyOf(event);
  const auto [known, is_new] = known_.try_emplace(key);
  if (!is_new) by_age_.erase(known->second);
  known->second = ++heard_;
  by_age_.emplace(heard_, key);
  if (by_age_.size() > capacity_) {
    forgot_ = true;
    known_.erase(by_age_.begin()->second);
    by_age_.erase(by_age_.begin());
  }
  return is_new;
}

}  // namespace terra::verifier

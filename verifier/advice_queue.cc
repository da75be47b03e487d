#include "verifier/advice_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "terrain/require.h"
#include "verifier/verify.h"

namespace terra::verifier {
namespace {

std::size_t BytesOf(const AdviceEvent& advice) {
  return advice.advisor.size() + advice.waypoints.size() * sizeof(Cell);
}

}  // namespace

std::int64_t StepsToJudge(const Route& route) {
  if (route.size() > kBusLimits.max_waypoints) return 0;
  std::int64_t steps = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    steps += ChebyshevDistance(route[i - 1], route[i]);
    if (steps >= kBusLimits.max_steps) return kBusLimits.max_steps;
  }
  return steps;
}

AdviceQueue::AdviceQueue(const Limits& limits)
    : limits_(limits), steps_left_(limits.burst_steps) {
  TERRA_REQUIRE(limits_.steps_per_us > 0 && limits_.messages_of_sender > 0);
  TERRA_REQUIRE(limits_.burst_steps >= Charge(kBusLimits.max_steps));
}

bool AdviceQueue::HasRoom(const Sender& sender, std::size_t more_bytes) const {
  return sender.waiting.size() < limits_.messages_of_sender &&
         sender.bytes + more_bytes <= limits_.bytes_of_sender;
}

AdviceEvent AdviceQueue::Remove(Sender& sender, Waiting::iterator at) {
  AdviceEvent advice = std::move(at->second);
  sender.waiting.erase(at);
  sender.bytes -= BytesOf(advice);
  bytes_ -= BytesOf(advice);
  --size_;
  return advice;
}

void AdviceQueue::Add(SenderId id, AdviceEvent advice) {
  const std::size_t bytes = BytesOf(advice);
  const bool is_new = !of_sender_.contains(id);
  if (bytes > limits_.bytes_of_sender ||
      (is_new && of_sender_.size() >= limits_.senders)) {
    ++dropped_;
    return;
  }
  Sender& sender = of_sender_[id];
  const std::int64_t steps =
      advice.kind == AdviceKind::kPropose ? StepsToJudge(advice.waypoints) : 0;
  const auto [begin, end] = sender.waiting.equal_range(steps);
  const bool waits = std::any_of(begin, end, [&](const auto& known) {
    return known.second == advice;
  });
  if (waits) return;
  while (!HasRoom(sender, bytes)) {
    Remove(sender, std::prev(sender.waiting.end()));
    ++dropped_;
  }
  sender.waiting.emplace(steps, std::move(advice));
  sender.bytes += bytes;
  bytes_ += bytes;
  ++size_;
  if (is_new) turns_.push_back(id);
}

void AdviceQueue::Refill(std::int64_t now_us) {
  if (now_us <= now_us_) return;
  // In unsigned arithmetic, since the first time is infinitely long ago.
  const std::uint64_t passed =
      static_cast<std::uint64_t>(now_us) - static_cast<std::uint64_t>(now_us_);
  now_us_ = now_us;
  const std::int64_t missing = limits_.burst_steps - steps_left_;
  const auto full_after =
      static_cast<std::uint64_t>(missing / limits_.steps_per_us + 1);
  steps_left_ += passed >= full_after
                     ? missing
                     : static_cast<std::int64_t>(passed) * limits_.steps_per_us;
}

std::int64_t AdviceQueue::Charge(std::int64_t steps) const {
  return std::max(steps, limits_.least_steps);
}

std::int64_t AdviceQueue::NextCharge() const {
  return Charge(of_sender_.at(turns_.front()).waiting.begin()->first);
}

std::optional<AdviceEvent> AdviceQueue::Next(std::int64_t now_us) {
  Refill(now_us);
  if (turns_.empty() || NextCharge() > steps_left_) return std::nullopt;
  steps_left_ -= NextCharge();
  const SenderId id = turns_.front();
  turns_.pop_front();
  const auto sender = of_sender_.find(id);
  AdviceEvent advice = Remove(sender->second, sender->second.waiting.begin());
  if (sender->second.waiting.empty()) {
    of_sender_.erase(sender);
  } else {
    turns_.push_back(id);
  }
  return advice;
}

std::int64_t AdviceQueue::next_us() const {
  if (turns_.empty()) return kNever;
  const std::int64_t missing = NextCharge() - steps_left_;
  if (missing <= 0) return now_us_;
  return now_us_ + (missing + limits_.steps_per_us - 1) / limits_.steps_per_us;
}

}  // namespace terra::verifier

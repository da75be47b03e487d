#include "verifier/journal_node.h"

#include <algorithm>
#include <utility>

#include "terrain/digest.h"

namespace terra::verifier {
namespace {

using terra_msg::gate_step_t;

// A step without its event, as it is on the wire, and some more.
constexpr std::int64_t kStepBytes = 320;
// What the layout takes.
constexpr std::size_t kMaxEventBytes = 59'000;
// What larger events leave for smaller ones, and these for bare steps.
constexpr std::size_t kSmallEventBytes = 4'000;
constexpr std::int64_t kForSmallEvents = 60'000;
constexpr std::int64_t kForBareSteps = 20'000;

}  // namespace

void JournalWriter::Write(gate_step_t step, Bytes event_bytes) {
  step.step = ++steps_;
  JournalBudget& budget =
      step.kind == gate_step_t::KIND_ADVICE ? advice_ : deployed_bus_;
  const std::int64_t leaves =
      event_bytes.size() > kSmallEventBytes ? kForSmallEvents : kForBareSteps;
  if (event_bytes.size() <= kMaxEventBytes && !event_bytes.empty() &&
      budget.Take(kStepBytes + std::ssize(event_bytes), leaves, step.now_us)) {
    step.bytes_digest = BytesDigest(event_bytes);
    step.num_bytes = static_cast<std::int32_t>(event_bytes.size());
    step.event_bytes = std::move(event_bytes);
  } else if (!budget.Take(kStepBytes, 0, step.now_us)) {
    ++left_out_;
    return;
  } else if (!event_bytes.empty()) {
    ++without_bytes_;
  }
  out_->Send(step);
}

bool JournalPlayer::Take(const gate_step_t& step) {
  if (step.session != session_ || step.step <= last_) return false;
  const bool first = last_ == 0;
  missing_ += step.step - last_ - 1;
  last_ = step.step;
  if (waiting_.size() < kMaxWaiting) {
    waiting_.push_back(step);
  } else {
    ++missing_;
  }
  return first;
}

void JournalPlayer::Take(bus::MapPtr map) {
  maps_.push_back(std::move(map));
  if (maps_.size() > kMaps) maps_.pop_front();
}

bus::MapPtr JournalPlayer::FindMap(std::int64_t map_id) const {
  const auto found = std::ranges::find_if(maps_, [map_id](const auto& map) {
    return map->map_id == map_id;
  });
  return found != maps_.end() ? *found : nullptr;
}

std::optional<JournalPlayer::Event> JournalPlayer::Next() {
  while (!waiting_.empty()) {
    const gate_step_t& step = waiting_.front();
    Result<GateEvent> event = EventOf(step, step.event_bytes);
    if (event) {
      if (auto* map_event = std::get_if<MapEvent>(&*event)) {
        const bus::MapPtr map = FindMap(map_event->map_id);
        if (!map) return std::nullopt;
        map_event->map = std::shared_ptr<const TerrainMap>(map, &map->map);
      }
      Event next{*std::move(event),
                 {step.kind,
                  {step.event_session, step.event_seq, step.event_digest},
                  step.event_bytes},
                 step.now_us,
                 step.core_after};
      waiting_.pop_front();
      return next;
    }
    ++missing_;
    waiting_.pop_front();
  }
  return std::nullopt;
}

}  // namespace terra::verifier

#include "logger/state_snapshot.h"

#include <algorithm>
#include <set>
#include <utility>

#include "bus/messages.h"
#include "terrain/digest.h"

namespace terra::logger {
namespace {

// Every message begins with fingerprint, utime, session, seq, of 8 bytes each.
bool SameButForStamps(std::span<const std::uint8_t> a,
                      std::span<const std::uint8_t> b) {
  const auto same = [&](std::size_t from, std::size_t length) {
    return std::ranges::equal(a.subspan(from, length), b.subspan(from, length));
  };
  return a.size() == b.size() && same(0, 8) && same(16, 8) &&
         same(32, a.size() - 32);
}

}  // namespace

void StateSnapshot::Take(bus::Channel channel, const HeardEvent& event) {
  switch (channel) {
    case bus::Channel::kMapHeader:
      return TakeHeader(event);
    case bus::Channel::kMapTile:
      return TakeTiles(event);
    case bus::Channel::kConfig:
      return TakeConfig(event);
    case bus::Channel::kBaseline:
      return TakeBaseline(event);
    case bus::Channel::kAdvice:
      return TakeAdvice(event);
    case bus::Channel::kPlanRequest:
      return TakeNewest<terra_msg::plan_request_t>(request_, event);
    case bus::Channel::kPose:
      return TakeNewest<terra_msg::pose_t>(pose_, event);
    case bus::Channel::kDeployed:
      return TakeDeployed(event);
    case bus::Channel::kVerdict:
      return TakeVerdict(event);
    case bus::Channel::kGateStep:
      return TakeStep(event);
    case bus::Channel::kMapRequest:
    case bus::Channel::kStatus:
    case bus::Channel::kLog:
      return;
  }
}

template <typename T>
void StateSnapshot::TakeNewest(Kept& kept, const HeardEvent& event) {
  if (bus::Decode<T>(event.data)) {
    kept = std::make_shared<const HeardEvent>(event);
  }
}

void StateSnapshot::TakeHeader(const HeardEvent& event) {
  const auto header = bus::Decode<terra_msg::map_header_t>(event.data);
  if (!header) return;
  if (map_ && map_->outline.map_id == header->map_id) {
    map_->header = std::make_shared<const HeardEvent>(event);  // newest stamps
    return;
  }
  Result<bus::MapOutline> outline = bus::ReadMapHeader(*header);
  if (!outline) return;
  KeptMap next{
      std::make_shared<const HeardEvent>(event), *std::move(outline), {}};
  next.tiles.resize(next.outline.tile_digests.size());
  std::vector<const KeptMap*> all_known;
  if (map_) all_known.push_back(&*map_);
  for (const KeptMap& old : old_maps_) all_known.push_back(&old);
  for (const KeptMap* known : all_known) {
    if (known->outline.grid.width != next.outline.grid.width ||
        known->outline.grid.height != next.outline.grid.height) {
      continue;
    }
    for (std::size_t i = 0; i < next.tiles.size(); ++i) {
      if (!next.tiles[i] &&
          known->outline.tile_digests[i] == next.outline.tile_digests[i]) {
        next.tiles[i] = known->tiles[i];
      }
    }
  }
  if (map_) old_maps_.push_back(*std::move(map_));
  map_ = std::move(next);
  DropOldMaps();
}

bool StateSnapshot::IsNamed(const KeptMap& map) const {
  return map.outline.map_id == deployed_map_id_ ||
         map.outline.map_id == journal_map_id_;
}

// The gate decides on a map only when it has all of it, so the ones before stay
// until DEPLOYED and journal name others.
void StateSnapshot::DropOldMaps() {
  std::erase_if(old_maps_, [this](const KeptMap& old) {
    return !IsNamed(old) || old.outline.map_id == map_->outline.map_id;
  });
}

void StateSnapshot::TakeDeployed(const HeardEvent& event) {
  const auto deployed = bus::Decode<terra_msg::deployed_t>(event.data);
  if (!deployed) return;
  Keep(GateOf(deployed->session), deployed->decision,
       {std::make_shared<const HeardEvent>(event), true});
  deployed_map_id_ = deployed->map_id;
  DropOldMaps();
}

void StateSnapshot::TakeVerdict(const HeardEvent& event) {
  const auto verdict = bus::Decode<terra_msg::verdict_t>(event.data);
  if (!verdict) return;
  Keep(GateOf(verdict->session), verdict->decision,
       {std::make_shared<const HeardEvent>(event), false});
}

void StateSnapshot::TakeStep(const HeardEvent& event) {
  const auto step = bus::Decode<terra_msg::gate_step_t>(event.data);
  std::int64_t last = 0;
  if (!step ||
      __builtin_add_overflow(step->decision, step->num_decisions, &last)) {
    return;
  }
  KeptGate& gate = GateOf(step->session);
  gate.step = std::make_shared<const HeardEvent>(event);
  gate.last_of_step = last;
  DropOldDecisions(gate);
  journal_map_id_ = step->kind == terra_msg::gate_step_t::KIND_MAP
                        ? step->event_digest
                        : step->map_id;
  DropOldMaps();
}

void StateSnapshot::Keep(KeptGate& gate, std::int64_t decision,
                         const KeptDecision& decided) {
  gate.decided.insert_or_assign(decision, decided);
  DropOldDecisions(gate);
}

// What goes: all before the DEPLOYED that was in force after the newest step,
// and verdicts that the step accounts for. Without a step, all but the newest
// of each.
void StateSnapshot::DropOldDecisions(KeptGate& gate) {
  auto& decided = gate.decided;
  bool newer_deployed = false;
  bool newer_verdict = false;
  for (auto at = decided.end(); at != decided.begin();) {
    --at;
    const bool is_deployed = at->second.is_deployed;
    bool& newer = is_deployed ? newer_deployed : newer_verdict;
    const bool awaits_step = gate.step && at->first > gate.last_of_step;
    const bool in_force = is_deployed || !gate.step;
    if (awaits_step) continue;
    if (in_force && !newer) {
      newer = true;
      continue;
    }
    at = decided.erase(at);
  }
  while (decided.size() > kMaxDecided) {
    decided.erase(std::next(decided.begin()));
  }
}

StateSnapshot::KeptGate& StateSnapshot::GateOf(std::int64_t session) {
  const auto known = std::ranges::find(gates_, session, &KeptGate::session);
  if (known != gates_.end()) return *known;
  if (gates_.size() == kMaxGates) gates_.pop_front();
  return gates_.emplace_back(KeptGate{session, nullptr, 0, {}});
}

void StateSnapshot::TakeTiles(const HeardEvent& event) {
  if (!map_) return;
  const auto message = bus::Decode<terra_msg::map_tile_t>(event.data);
  if (!message) return;
  const auto kept = std::make_shared<const HeardEvent>(event);
  std::span<const std::uint8_t> data(message->tile_data);
  for (std::size_t i = 0; i < message->tile_index.size(); ++i) {
    const std::int32_t size = message->tile_size[i];
    if (size < 0 || static_cast<std::size_t>(size) > data.size()) return;
    const auto frame = data.first(static_cast<std::size_t>(size));
    data = data.subspan(frame.size());
    TakeTile(kept, message->tile_index[i], frame);
  }
}

void StateSnapshot::TakeTile(const Kept& message, std::int32_t index,
                             std::span<const std::uint8_t> frame) {
  const bus::MapOutline& outline = map_->outline;
  if (index < 0 || index >= outline.grid.count()) return;
  Kept& tile = map_->tiles[static_cast<std::size_t>(index)];
  if (tile) return;
  // The digest in the message is only what its sender says.
  const auto ids = bus::UnpackTile(frame, outline.grid.rect(index).cells());
  if (ids && TileDigest(*ids) ==
                 outline.tile_digests[static_cast<std::size_t>(index)]) {
    tile = message;
  }
}

void StateSnapshot::TakeConfig(const HeardEvent& event) {
  const auto config = bus::Decode<terra_msg::config_t>(event.data);
  if (!config || (configs_.size() >= kMaxProcesses &&
                  !configs_.contains(config->config_name))) {
    return;
  }
  configs_[config->config_name] = std::make_shared<const HeardEvent>(event);
}

void StateSnapshot::TakeBaseline(const HeardEvent& event) {
  const auto baseline = bus::Decode<terra_msg::baseline_t>(event.data);
  if (!baseline) return;
  // Those without a route have digest 0, and the newest counts.
  std::erase_if(baselines_, [&baseline](const KeptBaseline& known) {
    return known.digest == baseline->baseline_digest &&
           known.planner == baseline->session;
  });
  baselines_.push_back({baseline->baseline_digest, baseline->session,
                        std::make_shared<const HeardEvent>(event)});
  if (baselines_.size() > kMaxBaselines) baselines_.pop_front();
}

void StateSnapshot::TakeAdvice(const HeardEvent& event) {
  if (!bus::Decode<terra_msg::advice_t>(event.data)) return;
  // Repetitions differ in the envelope only, and the first one is judged.
  const auto repeats = [&event](const Kept& known) {
    return SameButForStamps(known->data, event.data);
  };
  if (std::ranges::any_of(advice_, repeats)) return;
  advice_.push_back(std::make_shared<const HeardEvent>(event));
  if (advice_.size() > kMaxAdvice) advice_.pop_front();
}

void StateSnapshot::Visit(
    const std::function<void(const HeardEvent&)>& visit) const {
  for (const auto& [name, config] : configs_) visit(*config);
  std::set<const HeardEvent*> visited;
  const auto visit_map = [&](const KeptMap& map) {
    visit(*map.header);
    for (const Kept& tile : map.tiles) {
      if (tile && visited.insert(tile.get()).second) visit(*tile);
    }
  };
  for (const KeptMap& old : old_maps_) visit_map(old);
  if (map_) visit_map(*map_);
  if (request_) visit(*request_);
  for (const KeptBaseline& baseline : baselines_) visit(*baseline.message);
  for (const Kept& advice : advice_) visit(*advice);
  if (pose_) visit(*pose_);
  for (const KeptGate& gate : gates_) {
    if (gate.step) visit(*gate.step);
    for (const auto& [number, decided] : gate.decided) visit(*decided.message);
  }
}

}  // namespace terra::logger

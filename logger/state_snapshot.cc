#include "logger/state_snapshot.h"

#include <set>
#include <span>
#include <utility>

#include "bus/messages.h"
#include "terrain/digest.h"

namespace terra::logger {

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
      return TakeNewest<terra_msg::deployed_t>(deployed_, event);
    case bus::Channel::kMapRequest:
    case bus::Channel::kVerdict:
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
  if (outline_ && outline_->map_id == header->map_id) {
    header_ = std::make_shared<const HeardEvent>(event);  // the newest stamps
    return;
  }
  Result<bus::MapOutline> outline = bus::ReadMapHeader(*header);
  if (!outline) return;
  header_ = std::make_shared<const HeardEvent>(event);
  const bool same_grid = outline_ &&
                         outline_->grid.width == outline->grid.width &&
                         outline_->grid.height == outline->grid.height;
  std::vector<Kept> tiles(outline->tile_digests.size());
  for (std::size_t i = 0; same_grid && i < tiles.size(); ++i) {
    if (outline_->tile_digests[i] == outline->tile_digests[i]) {
      tiles[i] = tiles_[i];
    }
  }
  tiles_ = std::move(tiles);
  outline_ = *std::move(outline);
}

void StateSnapshot::TakeTiles(const HeardEvent& event) {
  if (!outline_) return;
  const auto message = bus::Decode<terra_msg::map_tile_t>(event.data);
  if (!message) return;
  Kept kept;
  std::span<const std::uint8_t> data(message->tile_data);
  for (std::size_t i = 0; i < message->tile_index.size(); ++i) {
    const std::int32_t size = message->tile_size[i];
    if (size < 0 || static_cast<std::size_t>(size) > data.size()) return;
    const auto frame = data.first(static_cast<std::size_t>(size));
    data = data.subspan(frame.size());
    const std::int32_t index = message->tile_index[i];
    if (index < 0 || index >= outline_->grid.count()) continue;
    Kept& tile = tiles_[static_cast<std::size_t>(index)];
    if (tile) continue;
    // The digest in the message is only what its sender says.
    const auto ids = bus::UnpackTile(frame, outline_->grid.rect(index).cells());
    if (!ids || TileDigest(*ids) !=
                    outline_->tile_digests[static_cast<std::size_t>(index)]) {
      continue;
    }
    if (!kept) kept = std::make_shared<const HeardEvent>(event);
    tile = kept;
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
  const auto kept = std::make_shared<const HeardEvent>(event);
  if (baseline->baseline_digest == baseline_digest_ && !baselines_.empty()) {
    baselines_.back() = kept;
    return;
  }
  baseline_digest_ = baseline->baseline_digest;
  advice_.clear();
  baselines_.push_back(kept);
  if (baselines_.size() > kMaxBaselines) baselines_.pop_front();
}

void StateSnapshot::TakeAdvice(const HeardEvent& event) {
  const auto advice = bus::Decode<terra_msg::advice_t>(event.data);
  if (!advice || advice->baseline_digest != baseline_digest_ ||
      baseline_digest_ == 0) {
    return;
  }
  const std::array<std::int64_t, 3> key = {advice->session, advice->attempt,
                                           advice->candidate};
  if (advice_.size() < kMaxAdvice || advice_.contains(key)) {
    advice_[key] = std::make_shared<const HeardEvent>(event);
  }
}

void StateSnapshot::Visit(
    const std::function<void(const HeardEvent&)>& visit) const {
  for (const auto& [name, config] : configs_) visit(*config);
  if (header_) visit(*header_);
  std::set<const HeardEvent*> visited;
  for (const Kept& tile : tiles_) {
    if (tile && visited.insert(tile.get()).second) visit(*tile);
  }
  if (request_) visit(*request_);
  for (const Kept& baseline : baselines_) visit(*baseline);
  for (const auto& [key, advice] : advice_) visit(*advice);
  for (const Kept& kept : {pose_, deployed_}) {
    if (kept) visit(*kept);
  }
}

}  // namespace terra::logger

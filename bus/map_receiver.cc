#include "bus/map_receiver.h"

#include <algorithm>

#include "terrain/digest.h"

namespace terra::bus {
namespace {

// Asked again this long after the last useful tile, so that what is under way
// is not asked for twice; the sender keeps its own pace on top.
constexpr Duration kQuiet = std::chrono::milliseconds(60);
constexpr Duration kAskPause = std::chrono::milliseconds(250);

}  // namespace

bool MapReceiver::OnHeader(const terra_msg::map_header_t& header, Time now) {
  if (!sender_.Accept(header.session, header.seq)) return false;
  const std::int64_t collecting = outline_ ? outline_->map_id : map_id();
  if (header.map_id == collecting || header.map_id == refused_id_) return false;
  Result<MapOutline> outline = ReadMapHeader(header);
  if (!outline) {
    last_error_ = outline.error().message;
    return false;
  }
  if (outline->map_id == map_id()) {  // back to what is in force
    outline_.reset();
    missing_ = 0;
    return false;
  }
  Begin(*std::move(outline));
  if (missing_ == 0) return Finish();
  Ask(now);
  return false;
}

void MapReceiver::Begin(MapOutline outline) {
  const TileGrid& grid = outline.grid;
  missing_ = grid.count();
  have_.assign(static_cast<std::size_t>(missing_), false);
  const bool same_grid = map_ && map_->map.width() == grid.width &&
                         map_->map.height() == grid.height;
  if (same_grid) {
    ids_ = map_->map.ids();
    for (std::size_t i = 0; i < have_.size(); ++i) {
      have_[i] = outline.tile_digests[i] == map_digests_[i];
      if (have_[i]) --missing_;
    }
  } else {
    ids_ = ByteRaster::Zero(grid.height, grid.width);
  }
  outline_ = std::move(outline);
}

bool MapReceiver::IsMissing(std::int32_t index) const {
  return index >= 0 && index < outline_->grid.count() &&
         !have_[static_cast<std::size_t>(index)];
}

bool MapReceiver::OnTiles(const terra_msg::map_tile_t& message, Time now) {
  if (!outline_) return false;
  std::span<const std::uint8_t> data(message.tile_data);
  for (std::size_t i = 0; i < message.tile_index.size(); ++i) {
    const std::int32_t size = message.tile_size[i];
    if (size < 0 || static_cast<std::size_t>(size) > data.size()) break;
    const auto frame = data.first(static_cast<std::size_t>(size));
    data = data.subspan(frame.size());
    const std::int32_t index = message.tile_index[i];
    if (!IsMissing(index)) continue;
    const Result<std::vector<std::uint8_t>> ids =
        UnpackTile(frame, outline_->grid.rect(index).cells());
    const auto at = static_cast<std::size_t>(index);
    if (!ids || TileDigest(*ids) != outline_->tile_digests[at]) continue;
    InsertTile(ids_, outline_->grid, index, *ids);
    have_[at] = true;
    --missing_;
    progress_at_ = now;
  }
  return missing_ == 0 && Finish();
}

bool MapReceiver::Finish() {
  MapOutline outline = *std::move(outline_);
  outline_.reset();
  Result<TerrainMap> map = TerrainMap::Create(
      std::move(ids_), std::move(outline.legend), outline.model);
  ids_ = ByteRaster();
  if (!map) {
    // Every tile is as the header lists it, so the map itself is wrong, and
    // would be the next time: do not collect it again.
    refused_id_ = outline.map_id;
    last_error_ = map.error().message;
    return false;
  }
  map_ = std::make_shared<const MapInForce>(
      MapInForce{*std::move(map), outline.map_id});
  map_digests_ = std::move(outline.tile_digests);
  last_error_.clear();
  return true;
}

void MapReceiver::Ask(Time now) {
  terra_msg::map_request_t request{};
  request.map_id = outline_->map_id;
  for (std::size_t i = 0; i < have_.size(); ++i) {
    if (!have_[i]) {
      request.missing_tile.push_back(static_cast<std::int32_t>(i));
    }
  }
  request.num_missing = static_cast<std::int32_t>(request.missing_tile.size());
  out_.Send(request);
  asked_at_ = now;
  progress_at_ = now;
}

Time MapReceiver::Advance(Time now) {
  if (!outline_) return kNever;
  const auto due = [&] {
    return std::max(asked_at_ + kAskPause, progress_at_ + kQuiet);
  };
  if (now >= due()) Ask(now);
  return due();
}

std::string MapReceiver::state() const {
  if (!outline_) return map_ ? "ready" : "waiting for map";
  return "waiting for map: " + std::to_string(missing_) + " of " +
         std::to_string(outline_->grid.count()) + " tiles missing";
}

}  // namespace terra::bus

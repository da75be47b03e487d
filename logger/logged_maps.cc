#include "logger/logged_maps.h"

#include <algorithm>
#include <span>

#include "terrain/digest.h"
#include "terrain/map_tiles.h"

namespace terra::logger {

bool LoggedMaps::Take(const terra_msg::map_header_t& header) {
  if (!outlines_.contains(header.map_id)) {
    Result<bus::MapOutline> outline = bus::ReadMapHeader(header);
    if (!outline) return false;
    outlines_.emplace(header.map_id, *std::move(outline));
  }
  if (sequence_.empty() || sequence_.back() != header.map_id) {
    sequence_.push_back(header.map_id);
  }
  return true;
}

bool LoggedMaps::Take(const terra_msg::map_tile_t& tiles) {
  std::span<const std::uint8_t> data(tiles.tile_data);
  for (std::size_t i = 0; i < tiles.tile_index.size(); ++i) {
    const std::int32_t size = tiles.tile_size[i];
    if (size < 0 || static_cast<std::size_t>(size) > data.size()) return false;
    const auto bytes = data.first(static_cast<std::size_t>(size));
    data = data.subspan(bytes.size());
    std::vector<Frame>& known =
        frames_[{tiles.tile_index[i], tiles.tile_digest[i]}];
    Frame frame(bytes.begin(), bytes.end());
    if (known.size() < kMaxVariants &&
        std::find(known.begin(), known.end(), frame) == known.end()) {
      known.push_back(std::move(frame));
    }
  }
  return data.empty();
}

bus::MapPtr LoggedMaps::Find(std::int64_t map_id) {
  for (const auto& [id, map] : made_) {
    if (id == map_id) return map;
  }
  bus::MapPtr map = Make(map_id);
  made_.emplace_back(map_id, map);
  if (made_.size() > kMaxMade) made_.pop_front();
  return map;
}

bus::MapPtr LoggedMaps::Make(std::int64_t map_id) const {
  const auto found = outlines_.find(map_id);
  if (found == outlines_.end()) return nullptr;
  const bus::MapOutline& outline = found->second;
  ByteRaster raster = ByteRaster::Zero(outline.grid.height, outline.grid.width);
  for (int i = 0; i < outline.grid.count(); ++i) {
    const auto ids =
        FindTile({i, outline.tile_digests[static_cast<std::size_t>(i)]},
                 outline.grid.rect(i).cells());
    if (!ids) return nullptr;
    InsertTile(raster, outline.grid, i, *ids);
  }
  auto terrain =
      TerrainMap::Create(std::move(raster), outline.legend, outline.model);
  if (!terrain) return nullptr;
  return std::make_shared<const bus::MapInForce>(
      bus::MapInForce{*std::move(terrain), map_id});
}

std::vector<std::string> LoggedMaps::Faults() const {
  std::vector<std::string> faults;
  for (const auto& [name, frames] : frames_) {
    if (faults.size() >= kMaxFaults) break;
    const std::string tile = "tile " + std::to_string(name.first);
    const bus::MapOutline* outline = MapThatLists(name);
    if (outline == nullptr) {
      faults.push_back(tile + " is of no map that the log holds");
      continue;
    }
    const std::size_t cells = outline->grid.rect(name.first).cells();
    const std::int64_t digest = name.second;
    const bool all_good = std::ranges::all_of(frames, [&](const Frame& frame) {
      const auto ids = bus::UnpackTile(frame, cells);
      return ids && TileDigest(*ids) == digest;
    });
    if (!all_good) faults.push_back(tile + " is not what it says");
  }
  return faults;
}

const bus::MapOutline* LoggedMaps::MapThatLists(TileName name) const {
  for (const auto& [map_id, outline] : outlines_) {
    if (name.first >= 0 && name.first < outline.grid.count() &&
        outline.tile_digests[static_cast<std::size_t>(name.first)] ==
            name.second) {
      return &outline;
    }
  }
  return nullptr;
}

std::optional<std::vector<std::uint8_t>> LoggedMaps::FindTile(
    TileName name, std::size_t cells) const {
  const auto found = frames_.find(name);
  if (found == frames_.end()) return std::nullopt;
  for (const Frame& frame : found->second) {
    auto ids = bus::UnpackTile(frame, cells);
    if (ids && TileDigest(*ids) == name.second) return *std::move(ids);
  }
  return std::nullopt;
}

}  // namespace terra::logger

#include "logger/log_contents.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "logger/log_channels.h"
#include "terrain/digest.h"
#include "terrain/map_tiles.h"

namespace terra::logger {
namespace {

template <typename T>
std::vector<std::uint8_t> WithoutEnvelope(T message) {
  message.utime = 0;
  message.session = 0;
  message.seq = 0;
  return bus::Encode(message);
}

}  // namespace

// ---- Maps ----

void LoggedMaps::Take(const terra_msg::map_header_t& header) {
  if (outlines_.contains(header.map_id)) return;
  Result<bus::MapOutline> outline = bus::ReadMapHeader(header);
  if (!outline) return;
  ids_.push_back(header.map_id);
  outlines_.emplace(header.map_id, *std::move(outline));
}

void LoggedMaps::Take(const terra_msg::map_tile_t& tiles) {
  std::span<const std::uint8_t> data(tiles.tile_data);
  for (std::size_t i = 0; i < tiles.tile_index.size(); ++i) {
    const std::int32_t size = tiles.tile_size[i];
    if (size < 0 || static_cast<std::size_t>(size) > data.size()) return;
    const auto frame = data.first(static_cast<std::size_t>(size));
    data = data.subspan(frame.size());
    frames_.try_emplace({tiles.tile_index[i], tiles.tile_digest[i]},
                        frame.begin(), frame.end());
  }
}

bus::MapPtr LoggedMaps::Find(std::int64_t map_id) {
  const auto made = made_.find(map_id);
  if (made != made_.end()) return made->second;
  bus::MapPtr& map = made_[map_id];
  const auto found = outlines_.find(map_id);
  if (found == outlines_.end()) return map;
  const bus::MapOutline& outline = found->second;
  ByteRaster raster = ByteRaster::Zero(outline.grid.height, outline.grid.width);
  for (int i = 0; i < outline.grid.count(); ++i) {
    const std::int64_t digest =
        outline.tile_digests[static_cast<std::size_t>(i)];
    const auto frame = frames_.find({i, digest});
    if (frame == frames_.end()) return map;
    const auto ids =
        bus::UnpackTile(frame->second, outline.grid.rect(i).cells());
    if (!ids || TileDigest(*ids) != digest) return map;
    InsertTile(raster, outline.grid, i, *ids);
  }
  auto terrain =
      TerrainMap::Create(std::move(raster), outline.legend, outline.model);
  if (!terrain) return map;
  map = std::make_shared<const bus::MapInForce>(
      bus::MapInForce{*std::move(terrain), map_id});
  return map;
}

// ---- Messages ----

LogContents LogContents::Load(LogReader& reader, SealChecker& seals) {
  LogContents contents;
  while (const auto item = reader.Next()) {
    const std::int64_t time_us = item->event.time_us;
    if (contents.events == 0) contents.first_us = contents.last_us = time_us;
    contents.first_us = std::min(contents.first_us, time_us);
    contents.last_us = std::max(contents.last_us, time_us);
    if (!seals.Take(*item)) contents.Take(item->event, contents.events);
    ++contents.events;
  }
  seals.Finish(reader.size());
  return contents;
}

void LogContents::Take(const LogEvent& event, std::int64_t index) {
  const auto channel = ChannelOf(event.channel);
  if (!channel) return;
  switch (*channel) {
    case bus::Channel::kMapHeader:
      return TakeAs<terra_msg::map_header_t>(event, index);
    case bus::Channel::kMapTile:
      return TakeAs<terra_msg::map_tile_t>(event, index);
    case bus::Channel::kPlanRequest:
      return TakeAs<terra_msg::plan_request_t>(event, index);
    case bus::Channel::kBaseline:
      return TakeAs<terra_msg::baseline_t>(event, index);
    case bus::Channel::kAdvice:
      return TakeAs<terra_msg::advice_t>(event, index);
    case bus::Channel::kVerdict:
      return TakeAs<terra_msg::verdict_t>(event, index);
    case bus::Channel::kDeployed:
      return TakeAs<terra_msg::deployed_t>(event, index);
    case bus::Channel::kPose:
      return TakeAs<terra_msg::pose_t>(event, index);
    case bus::Channel::kConfig:
      return TakeAs<terra_msg::config_t>(event, index);
    case bus::Channel::kStatus:
      return TakeAs<terra_msg::status_t>(event, index);
    case bus::Channel::kMapRequest:
    case bus::Channel::kLog:
      return;
  }
}

template <typename T>
void LogContents::TakeAs(const LogEvent& event, std::int64_t index) {
  Result<T> message = bus::Decode<T>(event.data);
  if (message) {
    Place(Logged<T>{index, event.time_us, *std::move(message)});
    return;
  }
  ++malformed;
  const auto channel = bus::MessageTraits<T>::kChannel;
  if (channel == bus::Channel::kVerdict || channel == bus::Channel::kDeployed) {
    conflicts.push_back({index, std::string(bus::BaseName(channel)) +
                                    " at event " + std::to_string(index) +
                                    " cannot be read"});
  }
}

template <typename Key, typename T, typename Other>
void LogContents::Keep(std::map<Key, Logged<T>>& kept, const Key& key,
                       const Logged<Other>& said, const char* what) {
  const auto [place, is_new] = kept.try_emplace(
      key, Logged<T>{said.index, said.time_us, T{said.message}});
  if (!is_new && Essence(place->second.message) != Essence(said.message)) {
    conflicts.push_back({said.index, std::string(what) + " at event " +
                                         std::to_string(said.index) +
                                         " differs from event " +
                                         std::to_string(place->second.index) +
                                         " of the same name"});
  }
}

void LogContents::Place(const Logged<terra_msg::map_header_t>& said) {
  maps.Take(said.message);
}

void LogContents::Place(const Logged<terra_msg::map_tile_t>& said) {
  maps.Take(said.message);
}

void LogContents::Place(const Logged<terra_msg::plan_request_t>& said) {
  const bool cancel =
      said.message.action == terra_msg::plan_request_t::ACTION_CANCEL;
  if (!cancel && said.message.action != terra_msg::plan_request_t::ACTION_GO) {
    return;  // No process takes it for anything.
  }
  Keep(cancel ? cancels : requests, said.message.request_id, said,
       "PLAN_REQUEST");
}

void LogContents::Place(const Logged<terra_msg::baseline_t>& said) {
  if (said.message.status == terra_msg::baseline_t::STATUS_OK) {
    Keep(baselines, said.message.baseline_digest, said, "BASELINE");
    return;
  }
  if (other_baselines.empty() ||
      Essence(other_baselines.back().message) != Essence(said.message)) {
    other_baselines.push_back(said);
  }
}

void LogContents::Place(const Logged<terra_msg::advice_t>& said) {
  const terra_msg::advice_t& message = said.message;
  const AdviceName name = {message.request_id,      message.map_id,
                           message.baseline_digest, message.session,
                           message.attempt,         message.candidate};
  Keep(advice, name, said, "ADVICE");
}

void LogContents::Place(const Logged<terra_msg::pose_t>& said) {
  poses.push_back(said);
}

void LogContents::Place(const Logged<terra_msg::verdict_t>& said) {
  Keep(decisions[said.message.session], said.message.decision, said, "VERDICT");
}

void LogContents::Place(const Logged<terra_msg::deployed_t>& said) {
  Keep(decisions[said.message.session], said.message.decision, said,
       "DEPLOYED");
}

void LogContents::Place(const Logged<terra_msg::config_t>& said) {
  configs.try_emplace(said.message.session, said.message);
}

void LogContents::Place(const Logged<terra_msg::status_t>& said) {
  statuses.push_back(said);
}

// ---- What a message says ----

std::vector<std::uint8_t> Essence(terra_msg::baseline_t message) {
  message.nodes_expanded = 0;
  message.edges_costed = 0;
  message.search_us = 0;
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::advice_t message) {
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::plan_request_t message) {
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::deployed_t message) {
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(terra_msg::verdict_t message) {
  message.t_det_us = 0;
  return WithoutEnvelope(std::move(message));
}

std::vector<std::uint8_t> Essence(const LogContents::Decided& message) {
  return std::visit(
      [](const auto& one) {
        return Essence(one);
      },
      message);
}

}  // namespace terra::logger

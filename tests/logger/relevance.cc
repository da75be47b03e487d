#include "tests/logger/relevance.h"

#include <algorithm>
#include <span>
#include <string>

#include "bus/map_exchange.h"
#include "terrain/map_tiles.h"

namespace terra::logger {
namespace {

using bus::Channel;

// The invariant leaves out utime, session, seq and T_det.
void Blank(terra_msg::verdict_t& message) {
  message.session = 0;
  message.t_det_us = 0;
}
void Blank(terra_msg::deployed_t& message) {
  message.session = 0;
}
void Blank(terra_msg::map_header_t& message) {
  message.session = 0;
  message.map_revision = 0;
  message.cell_size_m = 0;
  message.origin_x_m = 0;
  message.origin_y_m = 0;
  message.origin_yaw_rad = 0;
  std::ranges::fill(message.terrain_rgb, 0);
  std::ranges::fill(message.terrain_name, std::string());
}
void Blank(terra_msg::map_tile_t& message) {
  message.session = 0;
}
void Blank(terra_msg::config_t&) {}
// The time decides nothing while no rule of the gate uses it. Of advice the
// step holds what the gate reads, and names the whole message.
void Blank(terra_msg::gate_step_t& message) {
  message.now_us = 0;
  if (message.kind == terra_msg::gate_step_t::KIND_ADVICE) {
    message.event_digest = 0;
  }
}

template <typename T>
bool SameButForBlanks(const bus::RawMessage& a, const bus::RawMessage& b) {
  auto one = bus::Decode<T>(a.bytes);
  auto other = bus::Decode<T>(b.bytes);
  if (!one || !other) return false;
  for (T* message : {&*one, &*other}) {
    message->utime = 0;
    message->seq = 0;
    Blank(*message);
  }
  return bus::Encode(*one) == bus::Encode(*other);
}

// Returns whether the same tiles are packed otherwise: a zstd frame has bits
// that do not show in what it unpacks to.
bool AreTheSameTiles(const bus::RawMessage& honest,
                     const bus::RawMessage& changed) {
  const auto a = bus::Decode<terra_msg::map_tile_t>(honest.bytes);
  const auto b = bus::Decode<terra_msg::map_tile_t>(changed.bytes);
  if (!a || !b || a->tile_index != b->tile_index ||
      a->tile_digest != b->tile_digest || a->tile_size != b->tile_size) {
    return false;
  }
  const TerrainMap map = RecordedRun::BarMap(1);
  const TileGrid grid{map.width(), map.height()};
  std::size_t at = 0;
  for (std::size_t i = 0; i < a->tile_index.size(); ++i) {
    const std::size_t cells = grid.rect(a->tile_index[i]).cells();
    const auto size = static_cast<std::size_t>(a->tile_size[i]);
    const auto one =
        bus::UnpackTile(std::span(a->tile_data).subspan(at, size), cells);
    const auto other =
        bus::UnpackTile(std::span(b->tile_data).subspan(at, size), cells);
    if (!one || !other || *one != *other) return false;
    at += size;
  }
  return true;
}

}  // namespace

bool DecidesTheSame(const bus::RawMessage& honest,
                    const bus::RawMessage& changed) {
  switch (honest.channel) {
    case Channel::kMapHeader:
      return SameButForBlanks<terra_msg::map_header_t>(honest, changed);
    case Channel::kMapTile:
      return SameButForBlanks<terra_msg::map_tile_t>(honest, changed) ||
             AreTheSameTiles(honest, changed);
    case Channel::kVerdict:
      return SameButForBlanks<terra_msg::verdict_t>(honest, changed);
    case Channel::kDeployed:
      return SameButForBlanks<terra_msg::deployed_t>(honest, changed);
    case Channel::kConfig:
      return SameButForBlanks<terra_msg::config_t>(honest, changed);
    case Channel::kGateStep:
      return SameButForBlanks<terra_msg::gate_step_t>(honest, changed);
    default:
      return false;
  }
}

}  // namespace terra::logger

#include "bus/map_sender.h"

#include <algorithm>

namespace terra::bus {
namespace {

constexpr Duration kTilePause = std::chrono::milliseconds(200);
constexpr Duration kMessagePause = std::chrono::milliseconds(1);
// Index, digest and size of a tile beside its data.
constexpr std::size_t kBytesBesideTile = 16;
constexpr std::size_t kMaxTilesInMessage = 1024;

}  // namespace

void MapSender::SetMap(ByteRaster ids, terra_msg::map_header_t header) {
  const auto tiles = static_cast<std::size_t>(header.num_tiles);
  ids_ = std::move(ids);
  grid_ = TileGrid{header.width, header.height, header.tile_side};
  header_ = std::move(header);
  header_.map_revision = ++revision_;
  frames_.assign(tiles, {});
  sent_at_.assign(tiles, Time::min());
  wanted_.assign(tiles, false);
  queue_.clear();
  header_due_.Restart();
}

void MapSender::OnRequest(const terra_msg::map_request_t& request, Time now) {
  if (!has_map() || request.map_id != header_.map_id) return;
  for (const std::int32_t index : request.missing_tile) {
    if (index < 0 || index >= header_.num_tiles) continue;
    const auto i = static_cast<std::size_t>(index);
    const bool just_sent =
        sent_at_[i] != Time::min() && now < sent_at_[i] + kTilePause;
    if (wanted_[i] || just_sent) continue;
    wanted_[i] = true;
    queue_.push_back(index);
  }
}

Time MapSender::Advance(Time now) {
  if (!has_map()) return kNever;
  if (header_due_.Due(now)) out_.Send(header_);
  if (!queue_.empty() && now >= next_tiles_) {
    SendTiles(now);
    next_tiles_ = now + kMessagePause;
  }
  return queue_.empty() ? header_due_.next()
                        : std::min(header_due_.next(), next_tiles_);
}

void MapSender::SendTiles(Time now) {
  terra_msg::map_tile_t message{};
  std::size_t bytes = 0;
  while (!queue_.empty() && message.tile_index.size() < kMaxTilesInMessage) {
    const int index = queue_.front();
    const auto i = static_cast<std::size_t>(index);
    const std::vector<std::uint8_t>& frame = Frame(index);
    bytes += frame.size() + kBytesBesideTile;
    if (bytes > kTileMessageBytes && !message.tile_index.empty()) break;
    message.tile_index.push_back(index);
    message.tile_digest.push_back(header_.tile_digest[i]);
    message.tile_size.push_back(static_cast<std::int32_t>(frame.size()));
    message.tile_data.insert(message.tile_data.end(), frame.begin(),
                             frame.end());
    wanted_[i] = false;
    sent_at_[i] = now;
    queue_.pop_front();
  }
  message.num_tiles = static_cast<std::int32_t>(message.tile_index.size());
  message.num_bytes = static_cast<std::int32_t>(message.tile_data.size());
  tiles_sent_ += message.num_tiles;
  out_.Send(message);
}

const std::vector<std::uint8_t>& MapSender::Frame(int index) {
  std::vector<std::uint8_t>& frame = frames_[static_cast<std::size_t>(index)];
  if (frame.empty()) frame = CompressTile(ExtractTile(ids_, grid_, index));
  return frame;
}

}  // namespace terra::bus

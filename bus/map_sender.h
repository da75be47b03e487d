#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "bus/envelope.h"
#include "bus/map_exchange.h"
#include "bus/time.h"

namespace terra::bus {

/// Sends a map: its header 5 times a second, tiles on request.
///
/// A tile is sent at most once per 200 ms, whoever asks, since one datagram
/// reaches all; and at most 20 kB go out per ms, which receivers with default
/// socket buffers keep up with.
/// Threads: one.
class MapSender {
 public:
  explicit MapSender(Outbox& out) : out_(out) {}

  /// Puts a map in force. `header` is MakeMapHeader(map) with placement.
  void SetMap(ByteRaster ids, terra_msg::map_header_t header);

  void OnRequest(const terra_msg::map_request_t& request, Time now);

  /// Sends what is due; returns when to call again.
  Time Advance(Time now);

  bool has_map() const { return header_.map_id != 0; }
  const terra_msg::map_header_t& header() const { return header_; }
  std::int64_t tiles_sent() const { return tiles_sent_; }

 private:
  void SendTiles(Time now);
  const std::vector<std::uint8_t>& Frame(int index);

  Outbox& out_;
  terra_msg::map_header_t header_{};
  ByteRaster ids_;
  TileGrid grid_;
  std::vector<std::vector<std::uint8_t>> frames_;  // empty = not yet packed
  std::vector<Time> sent_at_;
  std::vector<bool> wanted_;
  std::deque<int> queue_;
  Periodic header_due_{kStatePeriod};
  Time next_tiles_ = Time::min();
  std::int64_t revision_ = 0;
  std::int64_t tiles_sent_ = 0;
};

}  // namespace terra::bus

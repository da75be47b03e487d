#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/envelope.h"
#include "bus/map_exchange.h"
#include "bus/time.h"

namespace terra::bus {

/// Receives the map in force: collects the tiles that a header lists and asks
/// again for those that are missing.
///
/// A new header keeps every tile of the last map that it lists at the same
/// place, so an update moves only what changed. The map stays the last complete
/// one until the next is complete.
/// Threads: one.
class MapReceiver {
 public:
  explicit MapReceiver(Outbox& out) : out_(out) {}

  /// Each returns true when another map came into force by it.
  bool OnHeader(const terra_msg::map_header_t& header, Time now);
  bool OnTiles(const terra_msg::map_tile_t& message, Time now);

  /// Asks for missing tiles when that is due; returns when to call again.
  Time Advance(Time now);

  /// The map in force; null until the first is complete.
  const MapPtr& map() const { return map_; }
  std::int64_t map_id() const { return map_ ? map_->map_id : 0; }

  int missing() const { return missing_; }
  const SenderTracker& sender() const { return sender_; }
  const std::string& last_error() const { return last_error_; }

  /// "ready", "waiting for map", or how much of it is there.
  std::string state() const;

 private:
  void Begin(MapOutline outline);
  bool Finish();
  bool IsMissing(std::int32_t index) const;
  void Ask(Time now);

  Outbox& out_;
  MapPtr map_;
  std::vector<std::int64_t> map_digests_;  // tiles of map_
  SenderTracker sender_;
  std::string last_error_;
  std::int64_t refused_id_ = 0;  // a complete map that is no valid one

  // The map that is being collected.
  std::optional<MapOutline> outline_;
  ByteRaster ids_;
  std::vector<bool> have_;
  int missing_ = 0;
  Time asked_at_ = Time::min();
  Time progress_at_ = Time::min();
};

}  // namespace terra::bus

#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/map_exchange.h"
#include "bus/messages.h"

namespace terra::logger {

/// The maps of a log: headers and, by their digests, the tiles.
///
/// Headers and tiles are taken for what their digests prove, not for what they
/// say: a tile that is not what it claims makes no map.
/// Bounds: memory of the log's distinct tiles and of kMaxMade maps.
class LoggedMaps {
 public:
  static constexpr std::size_t kMaxMade = 4;
  static constexpr std::size_t kMaxVariants = 4;
  static constexpr std::size_t kMaxFaults = 100;

  /// Returns whether the header is what its own map_id says.
  bool Take(const terra_msg::map_header_t& header);
  /// Returns whether the message's sizes fit its bytes.
  bool Take(const terra_msg::map_tile_t& tiles);

  /// Says which tiles are of no map, or not what they claim. To be asked when
  /// all is taken; at most kMaxFaults.
  std::vector<std::string> Faults() const;

  /// Returns a map whose every tile is in the log as its header lists it; null
  /// when something is missing.
  bus::MapPtr Find(std::int64_t map_id);

  /// In order of the headers; a map that came back is there again.
  const std::vector<std::int64_t>& sequence() const { return sequence_; }

 private:
  // (index, digest): the same digest may stand at places of other sizes.
  using TileName = std::pair<std::int32_t, std::int64_t>;
  using Frame = std::vector<std::uint8_t>;

  bus::MapPtr Make(std::int64_t map_id) const;
  std::optional<std::vector<std::uint8_t>> FindTile(TileName name,
                                                    std::size_t cells) const;
  const bus::MapOutline* MapThatLists(TileName name) const;

  std::map<std::int64_t, bus::MapOutline> outlines_;
  std::vector<std::int64_t> sequence_;
  std::map<TileName, std::vector<Frame>> frames_;
  std::deque<std::pair<std::int64_t, bus::MapPtr>> made_;
};

}  // namespace terra::logger

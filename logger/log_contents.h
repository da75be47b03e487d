#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "bus/map_exchange.h"
#include "bus/messages.h"
#include "logger/log_reader.h"
#include "logger/log_seal.h"

namespace terra::logger {

/// A message and its place in the log.
template <typename T>
struct Logged {
  std::int64_t index = 0;    ///< Of the event, from 0.
  std::int64_t time_us = 0;  ///< Of the event.
  T message;
};

/// What names an advice: the gate judges each only once.
struct AdviceName {
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  std::int64_t session = 0;
  std::int64_t attempt = 0;
  std::int32_t candidate = 0;

  friend auto operator<=>(const AdviceName&, const AdviceName&) = default;
};

/// The maps of a log: headers and, by their digests, the tiles.
class LoggedMaps {
 public:
  void Take(const terra_msg::map_header_t& header);
  void Take(const terra_msg::map_tile_t& tiles);

  /// Returns a map whose every tile is in the log as its header lists it; null
  /// when something is missing.
  bus::MapPtr Find(std::int64_t map_id);

  const std::vector<std::int64_t>& ids() const { return ids_; }

 private:
  // (index, digest): the same digest may stand at places of other sizes.
  using TileName = std::pair<std::int32_t, std::int64_t>;

  std::map<std::int64_t, bus::MapOutline> outlines_;
  std::vector<std::int64_t> ids_;  // In order of appearance.
  std::map<TileName, std::vector<std::uint8_t>> frames_;
  std::map<std::int64_t, bus::MapPtr> made_;
};

/// Two messages under one name that say different things, or a decision that
/// cannot be read.
struct Conflict {
  std::int64_t index = 0;
  std::string what;
};

/// What a log says, by name: repetitions are one thing said often.
///
/// Bounds: memory of the log's distinct messages. Malformed messages are left
/// out, and counted.
class LogContents {
 public:
  using Decided = std::variant<terra_msg::verdict_t, terra_msg::deployed_t>;

  /// Reads a log of one robot to its end.
  static LogContents Load(LogReader& reader, SealChecker& seals);

  LoggedMaps maps;
  /// By request_id; a cancelled request is in both.
  std::map<std::int64_t, Logged<terra_msg::plan_request_t>> requests;
  std::map<std::int64_t, Logged<terra_msg::plan_request_t>> cancels;
  /// By digest, those that have a route, and the others in order.
  std::map<std::int64_t, Logged<terra_msg::baseline_t>> baselines;
  std::vector<Logged<terra_msg::baseline_t>> other_baselines;
  std::map<AdviceName, Logged<terra_msg::advice_t>> advice;
  std::vector<Logged<terra_msg::pose_t>> poses;
  /// By session of the gate, then by number of the decision.
  std::map<std::int64_t, std::map<std::int64_t, Logged<Decided>>> decisions;
  /// By session of the sender.
  std::map<std::int64_t, terra_msg::config_t> configs;
  std::vector<Logged<terra_msg::status_t>> statuses;

  std::vector<Conflict> conflicts;
  std::int64_t malformed = 0;
  std::int64_t events = 0;
  std::int64_t first_us = 0;
  std::int64_t last_us = 0;

 private:
  void Take(const LogEvent& event, std::int64_t index);
  template <typename T>
  void TakeAs(const LogEvent& event, std::int64_t index);
  template <typename Key, typename T, typename Other>
  void Keep(std::map<Key, Logged<T>>& kept, const Key& key,
            const Logged<Other>& said, const char* what);

  void Place(const Logged<terra_msg::map_header_t>& said);
  void Place(const Logged<terra_msg::map_tile_t>& said);
  void Place(const Logged<terra_msg::plan_request_t>& said);
  void Place(const Logged<terra_msg::baseline_t>& said);
  void Place(const Logged<terra_msg::advice_t>& said);
  void Place(const Logged<terra_msg::pose_t>& said);
  void Place(const Logged<terra_msg::verdict_t>& said);
  void Place(const Logged<terra_msg::deployed_t>& said);
  void Place(const Logged<terra_msg::config_t>& said);
  void Place(const Logged<terra_msg::status_t>& said);
};

/// Returns the bytes of a message without what each sending of it changes:
/// utime, session, seq, and of a verdict the time it took.
std::vector<std::uint8_t> Essence(terra_msg::baseline_t message);
std::vector<std::uint8_t> Essence(terra_msg::advice_t message);
std::vector<std::uint8_t> Essence(terra_msg::plan_request_t message);
std::vector<std::uint8_t> Essence(terra_msg::deployed_t message);
std::vector<std::uint8_t> Essence(terra_msg::verdict_t message);
std::vector<std::uint8_t> Essence(const LogContents::Decided& message);

}  // namespace terra::logger

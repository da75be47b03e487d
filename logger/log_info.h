#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "logger/log_reader.h"
#include "logger/log_seal.h"
#include "terrain/result.h"

namespace terra::logger {

/// What a log holds of one channel.
struct ChannelInfo {
  std::int64_t events = 0;
  std::int64_t bytes = 0;  ///< Of data.
  std::int64_t first_us = 0;
  std::int64_t last_us = 0;
  /// Messages that never came, by gaps in seq of one session. Advice can show
  /// them too: the recorder hears no more than the gate's limits let through.
  std::int64_t missing = 0;
  std::int64_t repeated = 0;  ///< A seq not above the one before.
  std::int64_t sessions = 0;
  std::int64_t malformed = 0;  ///< Not of this channel's type.
  bool is_ours = false;        ///< The four above are known.

  /// Events per second between the first and the last; 0 for fewer than two.
  double rate_hz() const;
};

/// What a log holds, and what is wrong with it.
struct LogInfo {
  std::int64_t file_bytes = 0;
  std::int64_t events = 0;
  std::int64_t first_us = 0;  ///< Earliest and latest stamp of any event.
  std::int64_t last_us = 0;
  std::map<std::string, ChannelInfo> channels;
  std::int64_t snapshot_events = 0;  ///< State from before; in no channel.

  std::vector<LogDamage> damage;
  std::int64_t num_damaged_places = 0;
  std::int64_t num_damaged_bytes = 0;
  std::string read_error;

  /// Only logs of terra-logger have seals.
  bool sealed = false;
  std::int64_t good_seals = 0;
  std::vector<SealChecker::Broken> broken_seals;
  std::int64_t num_broken_seals = 0;
  std::int64_t lost = 0;  ///< As the recorder itself says.
  std::int64_t unsealed_bytes = 0;
  bool closed = false;
  std::optional<terra_msg::log_mark_t> header;

  /// Every byte is an event, and every seal fits. (A log that was cut by a kill
  /// between two events is intact, if not closed.)
  bool intact() const {
    return num_damaged_places == 0 && num_broken_seals == 0 &&
           read_error.empty();
  }
};

/// Reads a log to its end. Any bytes are safe; memory is bounded by the number
/// of channels and sessions named in the file, of which the first kMaxNames
/// are told apart.
LogInfo Inspect(LogReader& reader);

}  // namespace terra::logger

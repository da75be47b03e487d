#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "logger/log_reader.h"

namespace terra::logger {

/// Puts the times of a log's events on one line: from one event to the next it
/// goes on by what the log says, but never back, and by `max_gap_us` at most.
/// The first event keeps its time, if that is between 1970 and kLatestUs.
class EvenTime {
 public:
  /// In the year 2255; no time is later.
  static constexpr std::int64_t kLatestUs = std::int64_t{1} << 53;

  /// Pre: 0 < max_gap_us <= kLatestUs.
  explicit EvenTime(std::int64_t max_gap_us) : max_gap_us_(max_gap_us) {}

  std::int64_t Put(std::int64_t time_us);

  /// Steps that were changed.
  std::int64_t jumps() const { return jumps_; }

 private:
  std::int64_t max_gap_us_;
  std::optional<std::int64_t> before_us_;  // As the log says.
  std::int64_t now_us_ = 0;
  std::int64_t jumps_ = 0;
};

struct RebasedLog {
  std::int64_t events = 0;  ///< Written.
  std::int64_t jumps = 0;   ///< Steps of time that were changed.
};

/// Hands the events of a log to `write`, as bytes of an LCM event log, with
/// their times on one EvenTime and numbered anew. Leaves out the recorder's
/// marks, whose seals are of the old times.
RebasedLog RebaseLog(LogReader& reader, std::int64_t max_gap_us,
                     const std::function<void(std::string_view)>& write);

}  // namespace terra::logger

#include "logger/log_rebase.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bus/channels.h"
#include "logger/log_channels.h"
#include "logger/log_event.h"

namespace terra::logger {

std::int64_t EvenTime::Put(std::int64_t time_us) {
  if (!before_us_) {
    now_us_ = std::clamp<std::int64_t>(time_us, 0, kLatestUs);
  } else {
    // In unsigned arithmetic: times of a hostile log may be any numbers.
    const std::uint64_t step =
        time_us < *before_us_ ? 0
                              : static_cast<std::uint64_t>(time_us) -
                                    static_cast<std::uint64_t>(*before_us_);
    const auto most = static_cast<std::uint64_t>(max_gap_us_);
    if (time_us < *before_us_ || step > most) ++jumps_;
    now_us_ = std::min(
        now_us_ + static_cast<std::int64_t>(std::min(step, most)), kLatestUs);
  }
  before_us_ = time_us;
  return now_us_;
}

RebasedLog RebaseLog(LogReader& reader, std::int64_t max_gap_us,
                     const std::function<void(std::string_view)>& write) {
  EvenTime line(max_gap_us);
  RebasedLog rebased;
  std::vector<std::uint8_t> bytes;
  while (const auto item = reader.Next()) {
    LogEvent event = item->event;
    event.time_us = line.Put(event.time_us);
    if (ChannelOf(event.channel) == bus::Channel::kLog) continue;
    event.number = rebased.events++;
    bytes.clear();
    AppendLogEvent(bytes, event);
    write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  rebased.jumps = line.jumps();
  return rebased;
}

}  // namespace terra::logger

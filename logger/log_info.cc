#include "logger/log_info.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "bus/messages.h"
#include "logger/log_channels.h"

namespace terra::logger {
namespace {

constexpr std::size_t kMaxNames = 4096;
// Every message of the project begins with fingerprint, utime, session, seq.
constexpr std::size_t kSessionOffset = 16;
constexpr std::size_t kSeqOffset = 24;

using terra_msg::log_mark_t;

template <typename T>
bool IsWellFormed(std::span<const std::uint8_t> data) {
  return bus::CheckLayout(bus::MessageTraits<T>::kLayout, T::getHash(), data)
      .ok();
}

bool IsWellFormed(bus::Channel channel, std::span<const std::uint8_t> data) {
  switch (channel) {
    case bus::Channel::kMapHeader:
      return IsWellFormed<terra_msg::map_header_t>(data);
    case bus::Channel::kMapTile:
      return IsWellFormed<terra_msg::map_tile_t>(data);
    case bus::Channel::kMapRequest:
      return IsWellFormed<terra_msg::map_request_t>(data);
    case bus::Channel::kPlanRequest:
      return IsWellFormed<terra_msg::plan_request_t>(data);
    case bus::Channel::kBaseline:
      return IsWellFormed<terra_msg::baseline_t>(data);
    case bus::Channel::kAdvice:
      return IsWellFormed<terra_msg::advice_t>(data);
    case bus::Channel::kVerdict:
      return IsWellFormed<terra_msg::verdict_t>(data);
    case bus::Channel::kDeployed:
      return IsWellFormed<terra_msg::deployed_t>(data);
    case bus::Channel::kPose:
      return IsWellFormed<terra_msg::pose_t>(data);
    case bus::Channel::kStatus:
      return IsWellFormed<terra_msg::status_t>(data);
    case bus::Channel::kConfig:
      return IsWellFormed<terra_msg::config_t>(data);
    case bus::Channel::kLog:
      return IsWellFormed<log_mark_t>(data);
    case bus::Channel::kGateStep:
      return IsWellFormed<terra_msg::gate_step_t>(data);
  }
  return false;
}

// Counts what is missing in each sender's numbers, channel by channel.
class SeqCounter {
 public:
  void Count(const std::string& channel, ChannelInfo& info,
             std::span<const std::uint8_t> data) {
    const std::int64_t session = ReadBigEndian64(data.data() + kSessionOffset);
    const std::int64_t seq = ReadBigEndian64(data.data() + kSeqOffset);
    const auto found = last_.find({channel, session});
    if (found == last_.end()) {
      if (last_.size() >= kMaxNames) return;
      ++info.sessions;
      last_.emplace(std::pair(channel, session), seq);
      return;
    }
    if (seq <= found->second) {
      ++info.repeated;
      return;
    }
    // The difference of two hostile numbers may not fit.
    std::int64_t step = 0;
    if (!__builtin_sub_overflow(seq, found->second, &step)) {
      info.missing += std::min(step - 1, kMostMissing);
    }
    found->second = seq;
  }

 private:
  static constexpr std::int64_t kMostMissing = 1'000'000'000;

  std::map<std::pair<std::string, std::int64_t>, std::int64_t> last_;
};

void Count(const LogEvent& event, std::map<std::string, ChannelInfo>& channels,
           SeqCounter& seqs) {
  std::string name(event.channel);
  if (channels.size() >= kMaxNames && !channels.contains(name)) {
    name = "(others)";
  }
  ChannelInfo& info = channels[name];
  info.first_us =
      info.events == 0 ? event.time_us : std::min(info.first_us, event.time_us);
  info.last_us =
      info.events == 0 ? event.time_us : std::max(info.last_us, event.time_us);
  ++info.events;
  info.bytes += std::ssize(event.data);
  const auto channel = ChannelOf(event.channel);
  if (!channel) return;
  info.is_ours = true;
  if (IsWellFormed(*channel, event.data)) {
    seqs.Count(name, info, event.data);
  } else {
    ++info.malformed;
  }
}

}  // namespace

double ChannelInfo::rate_hz() const {
  const double seconds =
      1e-6 * (static_cast<double>(last_us) - static_cast<double>(first_us));
  return events < 2 || seconds <= 0 ? 0.0
                                    : static_cast<double>(events - 1) / seconds;
}

LogInfo Inspect(LogReader& reader) {
  LogInfo info;
  SealChecker seals;
  SeqCounter seqs;
  bool in_snapshot = false;
  while (const auto item = reader.Next()) {
    const std::int64_t time_us = item->event.time_us;
    info.first_us =
        info.events == 0 ? time_us : std::min(info.first_us, time_us);
    info.last_us = info.events == 0 ? time_us : std::max(info.last_us, time_us);
    ++info.events;
    const auto mark = seals.Take(*item);
    if (mark && mark->mark_kind == log_mark_t::KIND_HEADER) in_snapshot = true;
    if (mark && mark->mark_kind == log_mark_t::KIND_SNAPSHOT_END) {
      in_snapshot = false;
    }
    if (mark) continue;
    if (in_snapshot) {
      ++info.snapshot_events;
    } else {
      Count(item->event, info.channels, seqs);
    }
  }
  seals.Finish(reader.size());
  info.file_bytes = reader.size();
  info.damage = reader.damage();
  info.num_damaged_places = reader.num_damaged_places();
  info.num_damaged_bytes = reader.num_damaged_bytes();
  info.read_error = reader.read_error();
  info.sealed = seals.sealed();
  info.good_seals = seals.good();
  info.broken_seals = seals.broken();
  info.num_broken_seals = info.sealed ? seals.num_broken() : 0;
  info.lost = seals.lost();
  info.unsealed_bytes = seals.unsealed_bytes();
  info.closed = seals.closed();
  info.header = seals.header();
  return info;
}

}  // namespace terra::logger

#include "logger/logger_node.h"

#include <algorithm>
#include <utility>

#include "bus/envelope.h"
#include "bus/log.h"
#include "bus/messages.h"

namespace terra::logger {

LoggerNode::LoggerNode(Recorder recorder, bus::ChannelNames channels,
                       bus::Outbox& out)
    : channels_(std::move(channels)),
      disk_(std::move(recorder)),
      progress_(disk_.progress()),
      map_(out) {}

Status LoggerNode::Listen(const BusTap::Urls& urls) {
  auto tap = BusTap::Open(urls, channels_, queue_);
  if (!tap) return tap.error();
  tap_ = *std::move(tap);
  return Done{};
}

bus::Time LoggerNode::Advance(bus::Time now) {
  if (flush_.Due(now)) {
    TakeQueue();
    NoteProgress(now);
  }
  return std::min(map_.Advance(now), flush_.next());
}

void LoggerNode::TakeQueue() {
  EventQueue::Batch batch = queue_.Take();
  for (const HeardEvent& event : batch.events) FeedMap(event);
  disk_.Write(std::move(batch));
}

void LoggerNode::FeedMap(const HeardEvent& event) {
  const auto channel = channels_.Find(event.channel);
  if (channel == bus::Channel::kMapHeader) {
    const auto header = bus::Decode<terra_msg::map_header_t>(event.data);
    if (header) map_.OnHeader(*header, bus::Clock::now());
  } else if (channel == bus::Channel::kMapTile) {
    const auto tiles = bus::Decode<terra_msg::map_tile_t>(event.data);
    if (tiles) map_.OnTiles(*tiles, bus::Clock::now());
  }
}

// A failure that is mended at once (a file taken away, the next one begun) is
// said for kShownFor, so that a heartbeat tells of it.
void LoggerNode::NoteProgress(bus::Time now) {
  constexpr bus::Duration kShownFor = std::chrono::seconds(3);
  const std::int64_t failures_before = progress_.failures;
  progress_ = disk_.progress();
  std::string why;
  if (progress_.failing || progress_.failures > failures_before) {
    why = progress_.error;
  }
  if (disk_.WaitsForDisk(now) > kSlowDisk) {
    why = "the disk of " + progress_.path + " takes nothing";
  }
  if (!why.empty()) {
    failing_ = last_error_ = why;
    failed_ = now;
  } else if (!failing_.empty() && now - failed_ > kShownFor) {
    failing_.clear();
  }
}

bool LoggerNode::works() const {
  return disk_.Works(bus::Clock::now());
}

void LoggerNode::Finish() {
  tap_.reset();
  TakeQueue();
  finished_ = disk_.Finish(kFinishWait);
  progress_ = disk_.progress();
  if (!finished_) {
    bus::LogError("the disk of " + progress_.path +
                  " takes nothing; what waited for it is lost");
  } else if (progress_.failing) {
    bus::LogError(progress_.error);
  }
}

int LoggerNode::exit_code() const {
  return !finished_ || progress_.failing || progress_.lost > 0 ? 1 : 0;
}

std::string LoggerNode::state() const {
  return failing_.empty() ? "ready, recording to " + progress_.path
                          : "failing: " + failing_;
}

void LoggerNode::AddCounters(bus::Counters& counters) const {
  counters.emplace_back("acknowledged", progress_.acknowledged);
  counters.emplace_back("pending_bytes", progress_.pending_bytes);
  counters.emplace_back("lost", progress_.lost);
  counters.emplace_back("part", progress_.part);
  counters.emplace_back("deleted_parts", progress_.deleted_parts);
  if (!tap_) return;
  const BusTap::Counters& heard = tap_->counters();
  counters.emplace_back("heard", heard.heard);
  counters.emplace_back("refused", heard.refused);
  counters.emplace_back("tap_fragments", heard.fragments);
  counters.emplace_back("tap_no_message", heard.no_message);
  counters.emplace_back("tap_lost_in_kernel", heard.lost_in_kernel);
  counters.emplace_back("advice_over_limit", heard.advice_over_limit);
  counters.emplace_back("advisors_over_limit", heard.advisors_over_limit);
  counters.emplace_back("advice_malformed", heard.advice_malformed);
  counters.emplace_back("advice_lost_in_kernel", heard.advice_lost_in_kernel);
  counters.emplace_back("journal_foreign", heard.journal_foreign);
  counters.emplace_back("journal_over_limit", heard.journal_over_limit);
  counters.emplace_back("journal_lost_in_kernel", heard.journal_lost_in_kernel);
}

}  // namespace terra::logger

#include "logger/logger_node.h"

#include <algorithm>
#include <utility>

#include "bus/envelope.h"
#include "bus/messages.h"

namespace terra::logger {

LoggerNode::LoggerNode(Recorder recorder, bus::ChannelNames channels,
                       bus::Outbox& out)
    : recorder_(std::move(recorder)),
      channels_(std::move(channels)),
      map_(out) {}

Status LoggerNode::Listen(const BusTap::Urls& urls) {
  auto tap = BusTap::Open(urls, channels_.name(bus::Channel::kAdvice), queue_);
  if (!tap) return tap.error();
  tap_ = *std::move(tap);
  return Done{};
}

bus::Time LoggerNode::Advance(bus::Time now) {
  if (flush_.Due(now)) {
    TakeQueue();
    Note(recorder_.Flush(bus::UnixMicroseconds()));
  }
  return std::min(map_.Advance(now), flush_.next());
}

void LoggerNode::TakeQueue() {
  const EventQueue::Batch batch = queue_.Take();
  for (const HeardEvent& event : batch.events) {
    recorder_.Record(event);
    FeedMap(event);
  }
  if (batch.refused > 0) recorder_.CountLost(batch.refused);
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

void LoggerNode::Note(const Status& written) {
  failing_ = !written;
  if (failing_) last_error_ = written.error().message;
}

void LoggerNode::Finish() {
  tap_.reset();
  TakeQueue();
  Note(recorder_.Close(bus::UnixMicroseconds()));
}

int LoggerNode::exit_code() const {
  return failing_ || recorder_.lost() > 0 ? 1 : 0;
}

std::string LoggerNode::state() const {
  return failing_ ? "failing: " + last_error_
                  : "ready, recording to " + recorder_.path();
}

void LoggerNode::AddCounters(bus::Counters& counters) const {
  counters.emplace_back("acknowledged", recorder_.acknowledged_events());
  counters.emplace_back("pending_bytes", recorder_.pending_bytes());
  counters.emplace_back("lost", recorder_.lost());
  counters.emplace_back("part", recorder_.part());
  counters.emplace_back("deleted_parts", recorder_.deleted_parts());
  if (!tap_) return;
  const BusTap::Counters& heard = tap_->counters();
  counters.emplace_back("heard", heard.heard);
  counters.emplace_back("refused", heard.refused);
  counters.emplace_back("advice_over_limit", heard.advice_over_limit);
  counters.emplace_back("advice_malformed", heard.advice_malformed);
  counters.emplace_back("advice_lost_in_kernel", heard.advice_lost_in_kernel);
}

}  // namespace terra::logger

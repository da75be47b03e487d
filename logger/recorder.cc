#include "logger/recorder.h"

#include <algorithm>
#include <utility>

namespace terra::logger {
namespace {

using terra_msg::log_mark_t;

LogPart PartOf(const LogFolder& folder, const RecorderOptions& options,
               std::int64_t begin_us, int number) {
  return {folder.PartPath(begin_us, options.session, number),
          options.channels.name(bus::Channel::kLog), options.session, number};
}

int ShrinkForOneMore(const LogFolder& folder, const RecorderOptions& options) {
  if (options.quota_bytes == 0) return 0;
  return folder.ShrinkTo(
      std::max<std::int64_t>(0, options.quota_bytes - options.part_bytes));
}

}  // namespace

Result<Recorder> Recorder::Start(const std::string& folder,
                                 RecorderOptions options, std::int64_t now_us) {
  const Result<LogFolder> opened = LogFolder::Open(folder);
  if (!opened) return opened.error();
  const int deleted = ShrinkForOneMore(*opened, options);
  Result<LogWriter> writer =
      LogWriter::Create(PartOf(*opened, options, now_us, 0));
  if (!writer) return writer.error();
  Recorder recorder(*opened, std::move(options), now_us, *std::move(writer));
  recorder.deleted_parts_ = deleted;
  recorder.BeginPart(now_us);
  const Status flushed = recorder.Flush(now_us);
  if (!flushed) return flushed.error();
  return recorder;
}

Recorder::Recorder(LogFolder folder, RecorderOptions options,
                   std::int64_t begin_us, LogWriter writer)
    : folder_(std::move(folder)),
      options_(std::move(options)),
      begin_us_(begin_us),
      writer_(std::move(writer)) {}

// The snapshot's events carry the time at which the part begins, so that a
// player plays them at once; their own stamps are inside.
void Recorder::BeginPart(std::int64_t now_us) {
  writer_.Seal(now_us, log_mark_t::KIND_HEADER, options_.header);
  state_.Visit([this, now_us](const HeardEvent& event) {
    writer_.Append(now_us, event.channel, event.data);
  });
  writer_.Seal(now_us, log_mark_t::KIND_SNAPSHOT_END);
  part_begin_ = writer_.synced_bytes() + writer_.pending_bytes();
}

void Recorder::Record(const HeardEvent& event) {
  const auto channel = options_.channels.Find(event.channel);
  if (channel) state_.Take(*channel, event);
  if (writer_.pending_bytes() + std::ssize(event.data) >
      options_.max_pending_bytes) {
    ++lost_since_mark_;
    return;
  }
  writer_.Append(event.time_us, event.channel, event.data);
}

void Recorder::SealEvents(std::int64_t now_us) {
  if (!writer_.sealed()) writer_.Seal(now_us, log_mark_t::KIND_CHECKSUM);
  if (lost_since_mark_ > 0 &&
      writer_.pending_bytes() < options_.max_pending_bytes) {
    writer_.Seal(now_us, log_mark_t::KIND_LOST, "the disk is full or too slow",
                 lost_since_mark_);
    lost_ += std::exchange(lost_since_mark_, 0);
  }
}

Status Recorder::Flush(std::int64_t now_us) {
  SealEvents(now_us);
  const Status synced = writer_.Sync();
  if (!synced) return synced;
  return writer_.synced_bytes() - part_begin_ < options_.part_bytes
             ? Status(Done{})
             : Rotate(now_us);
}

Status Recorder::Rotate(std::int64_t now_us) {
  const int shrunk = ShrinkForOneMore(folder_, options_);
  deleted_parts_ += shrunk;
  Result<LogWriter> next =
      LogWriter::Create(PartOf(folder_, options_, begin_us_, part() + 1));
  if (!next) return next.error();
  writer_.Seal(now_us, log_mark_t::KIND_END);
  const Status ended = writer_.Sync();
  if (!ended) {
    next->Discard();
    return ended;
  }
  events_of_parts_before_ += writer_.synced_events();
  writer_ = *std::move(next);
  BeginPart(now_us);
  return writer_.Sync();
}

Status Recorder::Close(std::int64_t now_us) {
  SealEvents(now_us);
  writer_.Seal(now_us, log_mark_t::KIND_END);
  return writer_.Sync();
}

std::int64_t Recorder::acknowledged_events() const {
  return events_of_parts_before_ + writer_.synced_events();
}

}  // namespace terra::logger

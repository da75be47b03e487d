#include "logger/recorder.h"

#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

#include "bus/messages.h"
#include "logger/log_reader.h"

namespace terra::logger {
namespace {

using terra_msg::log_mark_t;

LogPart PartOf(const LogFolder& folder, const RecorderOptions& options,
               std::int64_t begin_us, int number) {
  return {folder.PartPath(begin_us, options.session, number),
          options.channels.name(bus::Channel::kLog), options.session, number};
}

// Of a killed recording at most so much of its end is looked at.
constexpr std::int64_t kMaxTailBytes = std::int64_t{16} << 20;

std::vector<std::uint8_t> TailOf(const StoredPart& part) {
  std::ifstream file(part.path, std::ios::binary);
  file.seekg(std::max<std::int64_t>(0, part.bytes - kMaxTailBytes));
  std::vector<std::uint8_t> tail(
      static_cast<std::size_t>(std::min(part.bytes, kMaxTailBytes)));
  file.read(reinterpret_cast<char*>(tail.data()), std::ssize(tail));
  tail.resize(static_cast<std::size_t>(file.gcount()));
  return tail;
}

// What the recording before said last, when it was not ended in order.
SequenceGaps GapsSince(const std::vector<StoredPart>& parts,
                       const RecorderOptions& options) {
  SequenceGaps gaps(options.channels);
  const std::string& mark_channel = options.channels.name(bus::Channel::kLog);
  const auto before =
      std::find_if(parts.rbegin(), parts.rend(), [&](const StoredPart& part) {
        return part.mark_channel == mark_channel && !IsBeingWritten(part.path);
      });
  if (before == parts.rend()) return gaps;
  const std::vector<std::uint8_t> tail = TailOf(*before);
  LogReader reader(tail);
  bool closed = false;
  while (const auto item = reader.Next()) {
    gaps.Remember(item->event.channel, item->event.data);
    closed = false;
    if (item->event.channel != mark_channel) continue;
    const auto mark = bus::Decode<log_mark_t>(item->event.data);
    closed = mark && mark->mark_kind == log_mark_t::KIND_END;
  }
  return closed ? SequenceGaps(options.channels) : gaps;
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
  const std::vector<StoredPart> parts = opened->Parts();
  const std::int64_t recording = parts.empty() ? 1 : parts.back().recording + 1;
  options.header += "\n" + RecordingLine(recording);
  SequenceGaps gaps = GapsSince(parts, options);
  const int deleted = ShrinkForOneMore(*opened, options);
  Result<LogWriter> writer =
      LogWriter::Create(PartOf(*opened, options, now_us, 0));
  if (!writer) return writer.error();
  Recorder recorder(*opened, std::move(options), now_us, *std::move(writer));
  recorder.deleted_parts_ = deleted;
  recorder.gaps_ = std::move(gaps);
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
      writer_(std::move(writer)),
      gaps_(options_.channels) {}

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
  const std::int64_t missing = gaps_.Missing(event.channel, event.data);
  if (missing > 0) {
    CountLost(missing);
    to_mark_.reason = "missing since the recording before, which was killed";
  }
  if (writer_.pending_bytes() + std::ssize(event.data) >
      options_.max_pending_bytes) {
    ++to_mark_.events;
    return;
  }
  writer_.Append(event.time_us, event.channel, event.data);
}

void Recorder::SealEvents(std::int64_t now_us) {
  if (!writer_.sealed()) writer_.Seal(now_us, log_mark_t::KIND_CHECKSUM);
  if (to_mark_.events > 0 &&
      writer_.pending_bytes() < options_.max_pending_bytes) {
    writer_.Seal(now_us, log_mark_t::KIND_LOST, to_mark_.reason,
                 to_mark_.events);
    lost_ += std::exchange(to_mark_, Loss{}).events;
  }
}

Status Recorder::Flush(std::int64_t now_us) {
  SealEvents(now_us);
  const Status synced = writer_.Sync();
  if (!synced && synced.error().code == ErrorCode::kNotFound) {
    const Status replaced = ReplaceFile(now_us, synced.error().message);
    return replaced ? synced : replaced;
  }
  if (!synced) return synced;
  return writer_.synced_bytes() - part_begin_ < options_.part_bytes
             ? Status(Done{})
             : Rotate(now_us);
}

// Another program took the file away: goes on in the next part, in a folder
// made anew if need be.
Status Recorder::ReplaceFile(std::int64_t now_us, const std::string& reason) {
  const Result<LogFolder> folder = LogFolder::Open(folder_.path());
  if (!folder) return folder.error();
  Result<LogWriter> next =
      LogWriter::Create(PartOf(*folder, options_, begin_us_, part() + 1));
  if (!next) return next.error();
  const LogWriter taken = std::exchange(writer_, *std::move(next));
  BeginPart(now_us);
  if (taken.synced_events_gone()) {
    CountLost(taken.synced_events());
    to_mark_.reason = reason;
  } else {
    events_of_parts_before_ += taken.synced_events();
  }
  AppendAgain(taken.pending());
  SealEvents(now_us);
  return writer_.Sync();
}

// Appends the events that a part which is gone had not synced. Its marks are of
// no use in another file; only how many events were lost is marked again.
void Recorder::AppendAgain(const std::vector<std::uint8_t>& events) {
  LogReader reader(events);
  while (const auto item = reader.Next()) {
    if (item->event.channel != writer_.part().mark_channel) {
      writer_.Append(item->event.time_us, item->event.channel,
                     item->event.data);
      continue;
    }
    const auto mark = bus::Decode<log_mark_t>(item->event.data);
    if (mark && mark->mark_kind == log_mark_t::KIND_LOST) {
      lost_ -= mark->num_events;
      CountLost(mark->num_events);
    }
  }
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

#include "logger/log_seal.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <utility>

#include "bus/messages.h"
#include "logger/log_channels.h"
#include "terrain/require.h"

namespace terra::logger {
namespace {

// Where the checksum lies in an encoded mark: after fingerprint, utime,
// session, seq, kind, version, part, first_byte, num_bytes, num_events.
constexpr std::size_t kChecksumOffset = 8 + 3 * 8 + 1 + 2 * 4 + 3 * 8;
constexpr std::array<std::uint8_t, 8> kNoChecksum{};

// Adds a mark's event, its checksum taken for 0, to what it covers; returns the
// checksum and begins to cover anew.
std::int64_t Seal(RunningChecksum& covered,
                  std::span<const std::uint8_t> mark_event,
                  std::size_t channel_bytes) {
  const std::size_t at = kLogHeaderBytes + channel_bytes + kChecksumOffset;
  TERRA_REQUIRE(mark_event.size() >= at + kNoChecksum.size());
  covered.Add(mark_event.first(at));
  covered.Add(kNoChecksum);
  covered.Add(mark_event.subspan(at + kNoChecksum.size()));
  const std::int64_t checksum = covered.Value();
  covered.Reset();
  return checksum;
}

}  // namespace

RunningChecksum::RunningChecksum() : state_(XXH3_createState()) {
  if (state_ == nullptr) {
    throw std::bad_alloc();
  }
  Reset();
}

void RunningChecksum::Free::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

void RunningChecksum::Reset() {
  XXH3_64bits_reset(state_.get());
}

void RunningChecksum::Add(std::span<const std::uint8_t> bytes) {
  XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
}

std::int64_t RunningChecksum::Value() const {
  return static_cast<std::int64_t>(XXH3_64bits_digest(state_.get()));
}

void AppendMark(std::vector<std::uint8_t>& bytes, LogEvent place,
                terra_msg::log_mark_t mark, RunningChecksum& covered) {
  mark.checksum = 0;
  const std::vector<std::uint8_t> unsealed = bus::Encode(mark);
  std::vector<std::uint8_t> event;
  place.data = unsealed;
  AppendLogEvent(event, place);
  mark.checksum = Seal(covered, event, place.channel.size());
  const std::vector<std::uint8_t> sealed = bus::Encode(mark);
  place.data = sealed;
  AppendLogEvent(bytes, place);
}

std::optional<terra_msg::log_mark_t> SealChecker::Take(
    const LogReader::Item& item) {
  closed_ = false;
  const std::int64_t begin = item.offset;
  end_ = begin + static_cast<std::int64_t>(item.raw.size());
  if (item.event.number != next_number_) {
    Break(begin, 0,
          "event " + std::to_string(next_number_) + " expected, event " +
              std::to_string(item.event.number) + " found");
  }
  next_number_ = item.event.number < std::numeric_limits<std::int64_t>::max()
                     ? item.event.number + 1
                     : 0;
  Result<terra_msg::log_mark_t> mark = Error{};
  if (ChannelOf(item.event.channel) == bus::Channel::kLog) {
    sealed_ = true;
    mark = bus::Decode<terra_msg::log_mark_t>(item.event.data);
    if (!mark) {
      Break(begin, std::ssize(item.raw), "a mark that cannot be read");
    }
  }
  if (!mark) {
    covered_.Add(item.raw);
    ++covered_events_;
    return std::nullopt;
  }

  const std::string fault = Check(item, *mark);
  if (fault.empty()) {
    ++good_;
    closed_ = mark->mark_kind == terra_msg::log_mark_t::KIND_END;
    if (mark->mark_kind == terra_msg::log_mark_t::KIND_LOST) {
      lost_ += std::max<std::int64_t>(0, mark->num_events);
    }
    if (!header_ && mark->mark_kind == terra_msg::log_mark_t::KIND_HEADER) {
      header_ = *mark;
    }
  } else {
    Break(covered_from_, end_ - covered_from_, fault);
  }
  covered_from_ = end_;
  covered_events_ = 0;
  return std::move(mark).value();
}

std::string SealChecker::Check(const LogReader::Item& item,
                               const terra_msg::log_mark_t& mark) {
  const std::int64_t checksum =
      Seal(covered_, item.raw, item.event.channel.size());
  if (mark.checksum != checksum) {
    return "changed: the checksum does not fit";
  }
  if (mark.first_byte != covered_from_ ||
      mark.num_bytes != item.offset - covered_from_) {
    return "bytes are missing or were put in";
  }
  if (mark.mark_kind <= terra_msg::log_mark_t::KIND_NONE ||
      mark.mark_kind > terra_msg::log_mark_t::KIND_LOST ||
      mark.format_version != kLogFormatVersion) {
    return "a mark of another format version";
  }
  return {};
}

void SealChecker::Finish(std::int64_t file_size) {
  unsealed_bytes_ = file_size - covered_from_;
  closed_ = closed_ && end_ == file_size;
}

void SealChecker::Break(std::int64_t offset, std::int64_t bytes,
                        std::string reason) {
  ++num_broken_;
  if (broken_.size() < kMaxBroken) {
    broken_.push_back({offset, bytes, std::move(reason)});
  }
}

}  // namespace terra::logger

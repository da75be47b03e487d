#include "logger/log_reader.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/stat.h>

namespace terra::logger {
namespace {

constexpr std::size_t kWindowBytes = std::size_t{1} << 20;
constexpr std::array<std::uint8_t, 4> kMagicBytes = {0xED, 0xA1, 0xDA, 0x01};

}  // namespace

Result<LogReader> LogReader::Open(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (fd < 0 || fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    const int reason = errno;
    const bool not_a_file = fd >= 0 && !S_ISREG(status.st_mode);
    if (fd >= 0) {
      close(fd);
    }
    return Error{!not_a_file && reason == ENOENT ? ErrorCode::kNotFound
                                                 : ErrorCode::kUnavailable,
                 "cannot read " + path + ": " +
                     (not_a_file ? "not a file" : std::strerror(reason))};
  }
  return LogReader(fd, status.st_size);
}

LogReader::LogReader(std::span<const std::uint8_t> bytes)
    : size_(static_cast<std::int64_t>(bytes.size())), window_(bytes) {}

LogReader::LogReader(LogReader&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      size_(other.size_),
      position_(other.position_),
      found_event_(other.found_event_),
      searched_from_(other.searched_from_),
      buffer_(std::move(other.buffer_)),
      window_(other.window_),
      window_offset_(other.window_offset_),
      damage_(std::move(other.damage_)),
      num_damaged_places_(other.num_damaged_places_),
      num_damaged_bytes_(other.num_damaged_bytes_),
      read_error_(std::move(other.read_error_)) {}

LogReader::~LogReader() {
  if (fd_ >= 0) {
    close(fd_);
  }
}

std::optional<LogReader::Item> LogReader::Next() {
  while (position_ < size_) {
    const std::int64_t bytes = EventSizeAt(position_);
    if (bytes == 0) {
      const std::int64_t next = FindEvent(position_ + 1);
      SkipTo(next, next == size_ && EventMayBeginAt(position_));
      continue;
    }
    const std::int64_t end = position_ + bytes;
    // Where no event follows, either this one's length is damaged, and then it
    // swallows others, or the damage begins behind it.
    if (!EventMayBeginAt(end)) {
      const std::int64_t next = FindEvent(position_ + 1);
      if (next < end) {
        SkipTo(next, false);
        continue;
      }
    }
    Item item;
    item.offset = position_;
    item.raw = View(position_, static_cast<std::size_t>(bytes))
                   .first(static_cast<std::size_t>(bytes));
    const ParsedLogEvent parsed = ParseLogEvent(item.raw);
    if (!parsed.complete) {
      continue;  // The file was cut while it was read; size_ says so now.
    }
    item.event = parsed.event;
    position_ = end;
    return item;
  }
  return std::nullopt;
}

// Returns the bytes from an offset on, at least `want` unless the file ends.
std::span<const std::uint8_t> LogReader::View(std::int64_t offset,
                                              std::size_t want) {
  const auto left = static_cast<std::size_t>(size_ - offset);
  want = std::min(want, left);
  const std::int64_t window_end =
      window_offset_ + static_cast<std::int64_t>(window_.size());
  if (fd_ >= 0 && (offset < window_offset_ ||
                   offset + static_cast<std::int64_t>(want) > window_end)) {
    buffer_.resize(std::min(left, std::max(want, kWindowBytes)));
    std::size_t have = 0;
    while (have < buffer_.size()) {
      const ssize_t got =
          pread(fd_, buffer_.data() + have, buffer_.size() - have,
                offset + static_cast<std::int64_t>(have));
      if (got < 0 && errno == EINTR) {
        continue;
      }
      if (got <= 0) {
        read_error_ = got < 0 ? std::strerror(errno) : "the file was cut";
        // As if the file ended here.
        size_ = offset + static_cast<std::int64_t>(have);
        break;
      }
      have += static_cast<std::size_t>(got);
    }
    buffer_.resize(have);
    window_ = buffer_;
    window_offset_ = offset;
  }
  return window_.subspan(static_cast<std::size_t>(offset - window_offset_));
}

// Returns the size of the whole event that begins at an offset, 0 if none does.
// Looks at the header and the channel only: a header may claim much, and a file
// of such claims must not make us read all they claim.
std::int64_t LogReader::EventSizeAt(std::int64_t offset) {
  const ParsedLogEvent parsed =
      ParseLogEvent(View(offset, kLogHeaderBytes + kMaxLogChannel));
  const auto bytes = static_cast<std::int64_t>(parsed.size);
  return parsed.valid && bytes <= size_ - offset ? bytes : 0;
}

// True at the end of the file and where it ends within a magic number.
bool LogReader::EventMayBeginAt(std::int64_t offset) {
  std::array<std::uint8_t, 4> bytes{};
  const auto length = static_cast<std::size_t>(
      std::min<std::int64_t>(size_ - offset, kMagicBytes.size()));
  const std::int64_t in_window = offset - window_offset_;
  if (in_window >= 0 && in_window + std::ssize(bytes) <= std::ssize(window_)) {
    std::memcpy(bytes.data(), window_.data() + in_window, length);
  } else if (fd_ < 0) {
    std::memcpy(bytes.data(), window_.data() + offset, length);
  } else if (pread(fd_, bytes.data(), length, offset) < 0) {
    return false;
  }
  return std::equal(bytes.begin(),
                    bytes.begin() + static_cast<std::ptrdiff_t>(length),
                    kMagicBytes.begin());
}

// Returns where the next whole event begins, or the end of the file.
std::int64_t LogReader::FindEvent(std::int64_t from) {
  // One search serves all positions up to what it found, which keeps the time
  // linear.
  if (found_event_ >= from && searched_from_ <= from) {
    return std::min(found_event_, size_);
  }
  searched_from_ = from;
  std::int64_t at = FindMagic(from);
  while (at < size_ && EventSizeAt(at) == 0) {
    at = FindMagic(at + 1);
  }
  found_event_ = std::min(at, size_);
  return found_event_;
}

std::int64_t LogReader::FindMagic(std::int64_t from) {
  while (from < size_) {
    const auto bytes = View(from, kMagicBytes.size());
    const auto found = std::search(bytes.begin(), bytes.end(),
                                   kMagicBytes.begin(), kMagicBytes.end());
    if (found != bytes.end()) {
      return from + (found - bytes.begin());
    }
    if (bytes.size() < kMagicBytes.size()) {
      break;
    }
    // It may lie across the end of what was seen.
    from += static_cast<std::int64_t>(bytes.size() - kMagicBytes.size() + 1);
  }
  return size_;
}

void LogReader::SkipTo(std::int64_t offset, bool torn_end) {
  ++num_damaged_places_;
  num_damaged_bytes_ += offset - position_;
  if (damage_.size() < kMaxDamage) {
    damage_.push_back({position_, offset - position_, torn_end});
  }
  position_ = offset;
}

}  // namespace terra::logger

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "logger/log_event.h"
#include "terrain/result.h"

namespace terra::logger {

/// Bytes of a log where there should be events and are none.
struct LogDamage {
  std::int64_t offset = 0;
  std::int64_t bytes = 0;
  bool torn_end = false;  ///< An event begins there and the file ends in it.
};

/// Reads LCM event logs, ours and others', and survives what liblcm's reader
/// does not: after damage it goes on with the next event that it finds. A
/// damaged byte costs the event it is in and no other.
///
/// Bounds: memory of one window of the file (1 MB, or one event if larger);
/// time
///         linear in the size. Any bytes are safe. Of the damage, the
///         first kMaxDamage places are kept and all are counted.
/// Threads: one at a time.
class LogReader {
 public:
  static constexpr std::size_t kMaxDamage = 1'000;

  /// Opens a file; what is appended later is not read.
  /// Errors: kNotFound, kUnavailable with the system's reason.
  static Result<LogReader> Open(const std::string& path);

  /// Reads from memory, which must outlive the reader.
  explicit LogReader(std::span<const std::uint8_t> bytes);

  LogReader(LogReader&& other) noexcept;
  LogReader& operator=(LogReader&&) = delete;
  ~LogReader();

  /// An event and where it is.
  struct Item {
    LogEvent event;
    std::int64_t offset = 0;
    std::span<const std::uint8_t> raw;  ///< All bytes of the event.
  };

  /// The next event, or nothing at the end. Views are valid until the next
  /// call.
  std::optional<Item> Next();

  std::int64_t size() const { return size_; }
  const std::vector<LogDamage>& damage() const { return damage_; }
  std::int64_t num_damaged_places() const { return num_damaged_places_; }
  std::int64_t num_damaged_bytes() const { return num_damaged_bytes_; }
  /// The system refused to read on; the rest of the file is missing.
  const std::string& read_error() const { return read_error_; }

 private:
  LogReader(int fd, std::int64_t size) : fd_(fd), size_(size) {}

  std::span<const std::uint8_t> View(std::int64_t offset, std::size_t want);
  std::int64_t EventSizeAt(std::int64_t offset);
  bool EventMayBeginAt(std::int64_t offset);
  std::int64_t FindEvent(std::int64_t from);
  std::int64_t FindMagic(std::int64_t from);
  void SkipTo(std::int64_t offset, bool torn_end);

  int fd_ = -1;  // -1 = window_ is all there is.
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
  std::int64_t found_event_ = -1;  // Result of the last search.
  std::int64_t searched_from_ = 0;

  std::vector<std::uint8_t> buffer_;
  std::span<const std::uint8_t> window_;
  std::int64_t window_offset_ = 0;

  std::vector<LogDamage> damage_;
  std::int64_t num_damaged_places_ = 0;
  std::int64_t num_damaged_bytes_ = 0;
  std::string read_error_;
};

}  // namespace terra::logger

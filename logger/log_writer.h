#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "logger/log_seal.h"
#include "terrain/result.h"

namespace terra::logger {

/// Which file of which recording.
struct LogPart {
  std::string path;
  std::string mark_channel;  ///< TERRA_LOG with the robot's prefix.
  std::int64_t session = 0;
  std::int32_t number = 0;
};

/// Writes one file in LCM's event-log format, sealed by marks.
///
/// An event is acknowledged when the Sync after its Append has returned well:
/// then it is on the disk (write and fdatasync) and no kill, crash or loss of
/// power takes it away. Until then it is in memory, also over any number of
/// failed Syncs: each writes again from the end of what is acknowledged, so a
/// full disk leaves no torn event behind and loses nothing that memory holds.
/// Other programs can take it away: each Sync looks whether the file is still
/// there under its name and has the size that was written.
///
/// Threads: one at a time.
class LogWriter {
 public:
  /// Makes a new file, never an existing one.
  /// Errors: kUnavailable with the system's reason.
  static Result<LogWriter> Create(LogPart part);

  LogWriter(LogWriter&& other) noexcept;
  LogWriter& operator=(LogWriter&& other) noexcept;
  ~LogWriter();  ///< Closes the file as it is; call Seal and Sync before.

  void Append(std::int64_t time_us, std::string_view channel,
              std::span<const std::uint8_t> data);

  /// Appends a mark of one of log_mark_t's kinds. num_events is how many were
  /// lost for KIND_LOST; else it is how many the mark seals, filled in here.
  void Seal(std::int64_t time_us, std::int8_t kind, std::string_view text = {},
            std::int64_t num_lost = 0);

  /// Puts all that was appended on the disk.
  /// Errors: kUnavailable with the system's reason; to be tried again.
  ///         kNotFound when another program deleted, moved, cut or wrote to the
  ///         file; no Sync will succeed any more, and pending() is to be
  ///         written to another file.
  Status Sync();

  /// The synced events are no longer on the disk (not all of them, where the
  /// file was only cut).
  bool synced_events_gone() const { return synced_events_gone_; }

  /// Closes the file and deletes it.
  void Discard();

  /// No event came since the last mark.
  bool sealed() const { return events_since_mark_ == 0; }
  std::int64_t synced_bytes() const { return synced_bytes_; }
  std::int64_t pending_bytes() const { return std::ssize(pending_); }
  /// The whole events, marks among them, that no Sync has put on the disk.
  const std::vector<std::uint8_t>& pending() const { return pending_; }
  std::int64_t synced_events() const { return synced_events_; }
  std::int64_t num_events() const { return num_events_; }
  const LogPart& part() const { return part_; }

 private:
  LogWriter(int fd, LogPart part) : fd_(fd), part_(std::move(part)) {}
  std::int64_t end() const { return synced_bytes_ + pending_bytes(); }
  Status CheckFile(std::int64_t expected_bytes);

  int fd_ = -1;
  LogPart part_;
  std::vector<std::uint8_t> pending_;
  std::int64_t synced_bytes_ = 0;
  std::int64_t synced_events_ = 0;
  std::int64_t num_events_ = 0;
  RunningChecksum since_mark_;
  std::int64_t since_mark_from_ = 0;
  std::int64_t events_since_mark_ = 0;
  std::int64_t num_marks_ = 0;
  bool torn_ = false;  // A failed write may have left bytes behind its end.
  bool synced_events_gone_ = false;
};

}  // namespace terra::logger

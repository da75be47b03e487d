#pragma once

#include <cstdint>
#include <string>

#include "bus/channels.h"
#include "logger/event_queue.h"
#include "logger/log_folder.h"
#include "logger/log_writer.h"
#include "logger/sequence_gaps.h"
#include "logger/state_snapshot.h"
#include "terrain/result.h"

namespace terra::logger {

/// How to record.
struct RecorderOptions {
  bus::ChannelNames channels;
  std::int64_t session = 0;
  std::string header;  ///< Who records what: build, host, URLs (for people).
  /// A part ends after so much behind its snapshot.
  std::int64_t part_bytes = std::int64_t{256} << 20;
  /// All parts in the folder together, of any recording; 0 = no limit.
  std::int64_t quota_bytes = 0;
  /// What memory holds while the disk takes nothing.
  std::int64_t max_pending_bytes = std::int64_t{64} << 20;
};

/// Writes one recording: a series of parts, each of which begins with a header
/// mark and the state in force (StateSnapshot), and whose events are sealed by
/// marks (log_seal.h).
///
/// An event is acknowledged when the Flush after its Record succeeded. A kill
/// at any moment, or a loss of power, costs only what came since the last
/// Flush, and leaves at most one torn event, which a reader finds. While the
/// disk takes nothing (full, gone) up to max_pending_bytes wait in memory.
///
/// Lost events are counted, and KIND_LOST marks say where they are missing:
///  - events that memory did not hold while the disk took nothing;
///  - acknowledged events that another program took away: it deleted or cut the
///    file. The recording goes on in a new part;
///  - events that came between the recording before, when that one was killed
///    or its machine went down, and this one. They are counted by the gaps in
///    their senders' seq (SequenceGaps).
///
/// Threads: one.
class Recorder {
 public:
  /// Begins the first part.
  /// Errors: a folder or file that cannot be made, with the system's reason.
  static Result<Recorder> Start(const std::string& folder,
                                RecorderOptions options, std::int64_t now_us);

  void Record(const HeardEvent& event);

  /// Counts events that were lost before they came here.
  void CountLost(std::int64_t events) { to_mark_.events += events; }

  /// Puts all that was recorded on the disk, and begins the next part when it
  /// is time.
  /// Errors: kUnavailable when the disk took nothing; to be tried again.
  ///         kNotFound, once, when another program took the file away; the next
  ///         part was begun.
  Status Flush(std::int64_t now_us);

  /// Flushes and ends the recording in order. Errors: as Flush.
  Status Close(std::int64_t now_us);

  std::int64_t acknowledged_events() const;
  std::int64_t pending_bytes() const { return writer_.pending_bytes(); }
  std::int64_t lost() const { return lost_ + to_mark_.events; }
  std::int64_t deleted_parts() const { return deleted_parts_; }
  int part() const { return writer_.part().number; }
  const std::string& path() const { return writer_.part().path; }

 private:
  // Lost events that no mark has told of yet.
  struct Loss {
    static constexpr const char* kDisk = "the disk is full or too slow";
    std::int64_t events = 0;
    std::string reason = kDisk;
  };

  Recorder(LogFolder folder, RecorderOptions options, std::int64_t begin_us,
           LogWriter writer);
  void BeginPart(std::int64_t now_us);
  Status Rotate(std::int64_t now_us);
  Status ReplaceFile(std::int64_t now_us, const std::string& reason);
  void AppendAgain(const std::vector<std::uint8_t>& events);
  void SealEvents(std::int64_t now_us);

  LogFolder folder_;
  RecorderOptions options_;
  std::int64_t begin_us_;
  LogWriter writer_;
  StateSnapshot state_;
  std::int64_t part_begin_ = 0;  // End of the snapshot in the file.
  std::int64_t events_of_parts_before_ = 0;
  std::int64_t lost_ = 0;
  Loss to_mark_;
  SequenceGaps gaps_;
  std::int64_t deleted_parts_ = 0;
};

}  // namespace terra::logger

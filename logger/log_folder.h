#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/result.h"

namespace terra::logger {

/// One part of a recording, by its name and by the header mark it begins with.
struct StoredPart {
  std::string path;
  std::int64_t bytes = 0;
  std::string mark_channel;  ///< Of the header mark: whose recording it is.
  /// Counts the recordings in this folder, from 1; 0 in parts that were written
  /// before recordings were counted. A clock that is wrong does not change it.
  std::int64_t recording = 0;
  std::int64_t session = 0;
  std::int32_t number = 0;
};

/// The folder that recordings lie in. File names are for people:
///
///   terra-20260131T235959Z-0123abcd.000.lcmlog
///
/// is the time the recording began (UTC, by a clock that may be wrong), its
/// session and the part's number. How old a part is follows from its header
/// mark alone.
class LogFolder {
 public:
  /// Makes the folder where it is missing.
  /// Errors: kUnavailable, with the system's reason.
  static Result<LogFolder> Open(const std::string& path);

  /// Returns the path of a part of a recording.
  std::string PartPath(std::int64_t begin_us, std::int64_t session,
                       int part) const;

  /// The parts of all recordings, oldest first. Regular files whose name has
  /// the form above and that begin with a header mark; nothing else.
  std::vector<StoredPart> Parts() const;

  /// Deletes the oldest parts, of any recording, until those that are left
  /// have at most `bytes` together. Parts that a logger is writing count, and
  /// stay; what is not in Parts() neither counts nor is touched. Returns how
  /// many were deleted.
  int ShrinkTo(std::int64_t bytes) const;

  const std::string& path() const { return path_; }

 private:
  explicit LogFolder(std::string path) : path_(std::move(path)) {}

  std::string path_;
};

/// Returns whether a file name has the form above.
bool IsPartName(std::string_view name);

/// The line of a header mark's text that counts the recording.
std::string RecordingLine(std::int64_t recording);

/// A logger is writing this part.
bool IsBeingWritten(const std::string& path);

}  // namespace terra::logger

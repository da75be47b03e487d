#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "terrain/result.h"

namespace terra::logger {

/// The folder that recordings lie in. Names sort by age:
///
///   terra-20260131T235959Z-0123abcd.000.lcmlog
///
/// is the time the recording began (UTC), its session and the part's number.
class LogFolder {
 public:
  /// Makes the folder where it is missing.
  /// Errors: kUnavailable, with the system's reason.
  static Result<LogFolder> Open(const std::string& path);

  /// Returns the path of a part of a recording.
  std::string PartPath(std::int64_t begin_us, std::int64_t session,
                       int part) const;

  /// Deletes the oldest parts, of any recording, until those that are left
  /// have at most `bytes` together. Parts that a logger is writing count, and
  /// stay; so does everything that is not named as above. Returns how many
  /// were deleted.
  int ShrinkTo(std::int64_t bytes) const;

  const std::string& path() const { return path_; }

 private:
  explicit LogFolder(std::string path) : path_(std::move(path)) {}

  std::string path_;
};

/// Returns whether a file name has the form above.
bool IsPartName(std::string_view name);

}  // namespace terra::logger

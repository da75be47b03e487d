#pragma once

#include <string>

#include "terrain/result.h"

namespace terra {

/// A file of this process alone, under a name of its own, that is gone when the
/// object is, or when SIGINT, SIGTERM or another signal ends the process.
/// (kill -9 and a power cut leave it: NAME.part-PID-NUMBER.)
///
/// The signals are taken only where the program left them to the system; a
/// program that handles them itself ends by its own way, through destructors.
/// Threads: each object belongs to one; many threads may have some.
class TemporaryFile {
 public:
  /// Creates an empty file in the folder of `path`, with a name made from its
  /// name and these permissions (less the umask), open to write.
  /// Errors: the folder refuses; the message is the system's, without a path.
  static Result<TemporaryFile> Create(const std::string& path, unsigned mode);

  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  ~TemporaryFile();

  const std::string& path() const { return path_; }
  int fd() const { return fd_; }

  /// Closes it and gives it the name `path` in one step; what had that name is
  /// gone. Errors: the system refuses; the file is still removed then.
  Status RenameTo(const std::string& path);

 private:
  TemporaryFile(std::string path, int slot, int fd)
      : path_(std::move(path)), slot_(slot), fd_(fd) {}

  void Remove();

  std::string path_;  ///< Empty = nothing to remove.
  int slot_;          ///< Among the files that a signal removes; -1 = none.
  int fd_;
};

}  // namespace terra

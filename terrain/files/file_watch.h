#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "terrain/result.h"

namespace terra {

/// What tells one state of a file from another: device, inode, size, times of
/// its content and of its entry. All 0 when there is none.
using FileStamp = std::array<std::int64_t, 7>;
FileStamp StampOf(const std::string& path);

/// Takes note of every file that its thread opens to read while it lives
/// (OpenToRead), also of those that are not there: what a map is made of.
class OpenedFiles {
 public:
  OpenedFiles();
  ~OpenedFiles();
  OpenedFiles(const OpenedFiles&) = delete;
  OpenedFiles& operator=(const OpenedFiles&) = delete;

  /// Path and stamp, taken before the file was opened; each path once.
  using List = std::vector<std::pair<std::string, FileStamp>>;
  List Take() { return std::move(list_); }

  /// For OpenToRead.
  static void Note(const std::string& path);

 private:
  List list_;
  OpenedFiles* outer_;
};

/// Reads something from files again when one of them changes: by writing, by
/// renaming another over it, by going and coming back. It watches what the last
/// attempt opened, so a file that another names is watched too.
///
/// Files are looked at by name and not by inotify, which is silent on network
/// file systems.
class FileWatch {
 public:
  /// Gets what is new from the files. Nothing must come of it yet: the files
  /// may change meanwhile.
  using Read = std::function<Status()>;

  explicit FileWatch(Read read) : read_(std::move(read)) {}

  /// Reads for the first time.
  Status Begin();

  /// To be called every kPeriodMs. Reads again when the files have changed and
  /// have been at rest since the last look, at the latest kMostUnrest looks
  /// after the change. Returns nothing when nothing was read, else how it went;
  /// what failed because of the system or a change meanwhile is tried again.
  std::optional<Status> Look();

  /// For who asks now and then: reads again when the files have changed.
  std::optional<Status> ReadIfChanged();

  static constexpr int kPeriodMs = 250;
  static constexpr int kMostUnrest = 4;

 private:
  Status Attempt();
  OpenedFiles::List Now() const;

  Read read_;
  OpenedFiles::List read_from_;
  OpenedFiles::List last_look_;
  int unrest_ = 0;
  bool again_ = false;
};

}  // namespace terra

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "output/temporary_file.h"
#include "terrain/result.h"

namespace terra {

/// Writes a file so that a reader sees the old content or the new, never a part
/// of it: beside it, under a temporary name, then renamed.
///
/// What the path names decides:
/// - A symbolic link is followed, also to a file that is not there yet; the
///   link stays.
/// - A file that is there keeps its permissions, and its owner and group where
///   the system lets us set them (else the group gets no more than others). Who
///   may not write it is refused. Root may write a read-only file; it stays
///   read-only. Another hard link keeps the old content; access lists and
///   extended attributes are not kept.
/// - A new file gets the usual permissions, 0666 less the umask.
/// - A pipe, a device, a socket, or an open descriptor of this process
///   (/dev/stdout, /dev/fd/N) is written as the bytes come, and stays what it
///   is.
/// - A folder is refused.
///
/// Without Finish nothing remains, also after Ctrl-C (see TemporaryFile).
class OutputFile {
 public:
  /// Errors, here and in the others: name the path and say the system's words.
  static Result<OutputFile> Create(const std::string& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  /// Appends. After a failure it does nothing.
  void Write(std::string_view bytes);

  /// The first failure so far. Bytes wait in a buffer, so a failure may show
  /// later; Finish shows every one.
  Status status() const;

  /// Gives the file its name. Once, at the end.
  Status Finish();

 private:
  OutputFile(std::string path, std::string target,
             std::optional<TemporaryFile> beside, int fd)
      : path_(std::move(path)),
        target_(std::move(target)),
        beside_(std::move(beside)),
        fd_(fd) {}

  int fd() const { return beside_ ? beside_->fd() : fd_; }
  void Flush();
  void Put(std::string_view bytes);

  std::string path_;    ///< As it was given, for messages.
  std::string target_;  ///< Behind all links.
  std::optional<TemporaryFile> beside_;
  int fd_ = -1;  ///< What is written through; -1 = `beside_` is written.
  std::string buffer_;
  std::optional<Error> failure_;
};

/// Writes a file by OutputFile, in one call.
Status WriteWholeFile(const std::string& path, std::string_view content);

}  // namespace terra

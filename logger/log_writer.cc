#include "logger/log_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <sys/file.h>
#include <sys/stat.h>

#include "bus/message_texts.h"

namespace terra::logger {
namespace {

Error SystemError(const std::string& what, const std::string& path) {
  return Error{ErrorCode::kUnavailable,
               what + " " + path + ": " + std::strerror(errno)};
}

// A new file's name is safe only when its folder is on the disk too. Some file
// systems cannot do that; the file's own content is not affected.
void SyncFolderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int fd = open(folder.empty() ? "." : folder.c_str(),
                      O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd >= 0) {
    fsync(fd);
    close(fd);
  }
}

}  // namespace

Result<LogWriter> LogWriter::Create(LogPart part) {
  const int fd =
      open(part.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) {
    return SystemError("cannot make", part.path);
  }
  // Says to other loggers in this folder that the file is in use.
  flock(fd, LOCK_EX | LOCK_NB);
  SyncFolderOf(part.path);
  return LogWriter(fd, std::move(part));
}

LogWriter::LogWriter(LogWriter&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      part_(std::move(other.part_)),
      pending_(std::move(other.pending_)),
      synced_bytes_(other.synced_bytes_),
      synced_events_(other.synced_events_),
      num_events_(other.num_events_),
      since_mark_(std::move(other.since_mark_)),
      since_mark_from_(other.since_mark_from_),
      events_since_mark_(other.events_since_mark_),
      num_marks_(other.num_marks_),
      torn_(other.torn_),
      synced_events_gone_(other.synced_events_gone_) {}

LogWriter& LogWriter::operator=(LogWriter&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(part_, other.part_);
  std::swap(pending_, other.pending_);
  std::swap(synced_bytes_, other.synced_bytes_);
  std::swap(synced_events_, other.synced_events_);
  std::swap(num_events_, other.num_events_);
  std::swap(since_mark_, other.since_mark_);
  std::swap(since_mark_from_, other.since_mark_from_);
  std::swap(events_since_mark_, other.events_since_mark_);
  std::swap(num_marks_, other.num_marks_);
  std::swap(torn_, other.torn_);
  std::swap(synced_events_gone_, other.synced_events_gone_);
  return *this;
}

LogWriter::~LogWriter() {
  if (fd_ >= 0) {
    close(fd_);
  }
}

void LogWriter::Append(std::int64_t time_us, std::string_view channel,
                       std::span<const std::uint8_t> data) {
  const std::size_t begin = pending_.size();
  AppendLogEvent(pending_, {num_events_, time_us, channel, data});
  since_mark_.Add(std::span(pending_).subspan(begin));
  ++num_events_;
  ++events_since_mark_;
}

void LogWriter::Seal(std::int64_t time_us, std::int8_t kind,
                     std::string_view text, std::int64_t num_lost) {
  terra_msg::log_mark_t mark{};
  mark.utime = time_us;
  mark.session = part_.session;
  mark.seq = ++num_marks_;
  mark.mark_kind = kind;
  mark.format_version = kLogFormatVersion;
  mark.part = part_.number;
  mark.first_byte = since_mark_from_;
  mark.num_bytes = end() - since_mark_from_;
  mark.num_events =
      kind == terra_msg::log_mark_t::KIND_LOST ? num_lost : events_since_mark_;
  mark.mark_text = text;
  bus::CleanTexts(mark);
  AppendMark(pending_, {num_events_, time_us, part_.mark_channel, {}}, mark,
             since_mark_);
  ++num_events_;
  since_mark_from_ = end();
  events_since_mark_ = 0;
}

Status LogWriter::Sync() {
  // Before, since the write may hide that the file was cut; and after, since
  // only what is still there then is acknowledged.
  const Status untouched = CheckFile(synced_bytes_);
  if (!untouched) return untouched;
  std::size_t written = 0;
  while (written < pending_.size()) {
    const ssize_t count =
        pwrite(fd_, pending_.data() + written, pending_.size() - written,
               synced_bytes_ + static_cast<std::int64_t>(written));
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      const Error error = SystemError("cannot write", part_.path);
      // Takes the torn event away. If that fails too it is overwritten when
      // there is room, or found by its seal.
      torn_ = ftruncate(fd_, synced_bytes_) != 0;
      return error;
    }
    written += static_cast<std::size_t>(count);
  }
  if (written > 0 && fdatasync(fd_) != 0) {
    return SystemError("cannot sync", part_.path);
  }
  if (written > 0) torn_ = false;
  const Status kept =
      CheckFile(synced_bytes_ + static_cast<std::int64_t>(written));
  if (!kept) return kept;
  synced_bytes_ += static_cast<std::int64_t>(written);
  synced_events_ = num_events_;
  pending_.clear();
  return Done{};
}

Status LogWriter::CheckFile(std::int64_t expected_bytes) {
  struct stat open_file {};
  struct stat named {};
  if (fstat(fd_, &open_file) != 0) {
    return SystemError("cannot look at", part_.path);
  }
  const bool is_there = stat(part_.path.c_str(), &named) == 0 &&
                        named.st_dev == open_file.st_dev &&
                        named.st_ino == open_file.st_ino;
  const char* done = nullptr;
  if (open_file.st_nlink == 0) {
    done = " was deleted";
  } else if (!is_there) {
    done = " was moved or replaced";
  } else if (open_file.st_size < expected_bytes) {
    done = " was cut";
  } else if (open_file.st_size > expected_bytes && !torn_) {
    done = " was written to";
  }
  if (done == nullptr) return Done{};
  synced_events_gone_ =
      open_file.st_nlink == 0 || open_file.st_size < expected_bytes;
  return Error{ErrorCode::kNotFound,
               part_.path + done + " by another program while it was recorded"};
}

void LogWriter::Discard() {
  close(std::exchange(fd_, -1));
  unlink(part_.path.c_str());
}

}  // namespace terra::logger

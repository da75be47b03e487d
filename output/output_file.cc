#include "output/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <sys/stat.h>

namespace terra {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferBytes = 64 << 10;
constexpr int kMaxLinks = 40;  // As Linux.
constexpr mode_t kNewFile = 0666;
constexpr mode_t kPermissions = 07777;

Error CannotWrite(const std::string& path, const std::string& reason) {
  return Error{ErrorCode::kUnavailable,
               path + ": cannot be written: " + reason};
}
Error CannotWrite(const std::string& path, int number) {
  return CannotWrite(path, std::strerror(number));
}

// Links in /proc lead to what a process has open, which need not have a name:
// they cannot be followed by reading them.
bool IsOpenDescriptor(const fs::path& link) {
  std::error_code failed;
  const fs::path folder = fs::canonical(link.parent_path(), failed);
  return !failed && folder.string().starts_with("/proc/") &&
         folder.filename() == "fd";
}

// The number of a descriptor of this process; -1 where it is another's.
int OwnDescriptor(const fs::path& link) {
  std::error_code failed;
  const fs::path folder = fs::canonical(link.parent_path(), failed);
  if (!folder.string().starts_with("/proc/" + std::to_string(::getpid()) +
                                   "/")) {
    return -1;
  }
  const std::string name = link.filename().string();
  int number = -1;
  const auto end =
      std::from_chars(name.data(), name.data() + name.size(), number);
  return end.ptr == name.data() + name.size() ? number : -1;
}

// Follows links until what is no link or cannot be followed by name.
Result<std::string> BehindLinks(const std::string& path) {
  fs::path at(path);
  for (int i = 0; i < kMaxLinks; ++i) {
    std::error_code failed;
    if (!fs::is_symlink(fs::symlink_status(at, failed))) return at.string();
    if (IsOpenDescriptor(at)) return at.string();
    const fs::path next = fs::read_symlink(at, failed);
    if (failed) return CannotWrite(path, failed.message());
    at = at.parent_path() / next;  // An absolute `next` replaces all.
  }
  return CannotWrite(path, ELOOP);
}

// Permissions last: the system takes some away when the owner changes.
bool KeepOwnerAndMode(int fd, const struct stat& old) {
  struct stat own = {};
  if (::fstat(fd, &own) != 0) return false;
  mode_t mode = old.st_mode & kPermissions;
  if (own.st_uid != old.st_uid &&
      ::fchown(fd, old.st_uid, static_cast<gid_t>(-1)) != 0) {
    mode &= ~static_cast<mode_t>(S_ISUID);
  }
  if (own.st_gid != old.st_gid &&
      ::fchown(fd, static_cast<uid_t>(-1), old.st_gid) != 0) {
    // What that group was allowed is not for ours.
    const mode_t others_as_group = (mode & S_IRWXO) << 3;
    mode &= ~static_cast<mode_t>(S_ISGID | S_IRWXG) | others_as_group;
  }
  return ::fchmod(fd, mode) == 0;
}

int OpenToWriteThrough(const std::string& target) {
  const int own = IsOpenDescriptor(target) ? OwnDescriptor(target) : -1;
  if (own >= 0) return ::fcntl(own, F_DUPFD_CLOEXEC, 0);
  return ::open(target.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
}

// Returns the error's number; 0 = all is written.
int WriteAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

Result<OutputFile> OutputFile::Create(const std::string& path) {
  const Result<std::string> found = BehindLinks(path);
  if (!found.ok()) return found.error();
  const std::string& target = *found;

  struct stat old = {};
  const bool there = ::stat(target.c_str(), &old) == 0;
  if (!there && errno != ENOENT) return CannotWrite(path, errno);
  if (there && S_ISDIR(old.st_mode)) return CannotWrite(path, EISDIR);
  if (there && (!S_ISREG(old.st_mode) || IsOpenDescriptor(target))) {
    const int fd = OpenToWriteThrough(target);
    if (fd < 0) return CannotWrite(path, errno);
    return OutputFile(path, target, std::nullopt, fd);
  }
  if (there && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) {
    return CannotWrite(path, errno);
  }
  Result<TemporaryFile> beside = TemporaryFile::Create(
      target, there ? old.st_mode & (S_IRUSR | S_IWUSR) : kNewFile);
  if (!beside.ok()) {
    const std::string folder = fs::path(target).parent_path().string();
    return CannotWrite(path, beside.error().message + " (folder " +
                                 (folder.empty() ? "." : folder) + ")");
  }
  if (there && !KeepOwnerAndMode(beside->fd(), old)) {
    return CannotWrite(path, errno);
  }
  return OutputFile(path, target, *std::move(beside), -1);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      beside_(std::move(other.beside_)),
      fd_(std::exchange(other.fd_, -1)),
      buffer_(std::move(other.buffer_)),
      failure_(std::move(other.failure_)) {}

OutputFile::~OutputFile() {
  if (fd_ >= 0) ::close(fd_);
}

void OutputFile::Write(std::string_view bytes) {
  if (failure_) return;
  if (buffer_.size() + bytes.size() >= kBufferBytes) {
    Flush();
    Put(bytes);
  } else {
    buffer_ += bytes;
  }
}

Status OutputFile::status() const {
  if (failure_) return *failure_;
  return Done{};
}

Status OutputFile::Finish() {
  Flush();
  if (!failure_ && fd_ >= 0 && ::close(std::exchange(fd_, -1)) != 0) {
    failure_ = CannotWrite(path_, errno);
  }
  if (!failure_ && beside_) {
    const Status named = beside_->RenameTo(target_);
    if (!named.ok()) failure_ = CannotWrite(path_, named.error().message);
  }
  beside_.reset();
  return status();
}

void OutputFile::Flush() {
  Put(buffer_);
  buffer_.clear();
}

void OutputFile::Put(std::string_view bytes) {
  if (failure_) return;
  const int error = WriteAll(fd(), bytes);
  if (error != 0) failure_ = CannotWrite(path_, error);
}

Status WriteWholeFile(const std::string& path, std::string_view content) {
  Result<OutputFile> file = OutputFile::Create(path);
  if (!file.ok()) return file.error();
  file->Write(content);
  return file->Finish();
}

}  // namespace terra

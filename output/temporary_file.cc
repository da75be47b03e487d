#include "output/temporary_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <utility>

namespace terra {
namespace {

// The files to remove when a signal ends the process. Fixed memory, because a
// signal handler may use nothing else. Where more files are open at once, those
// beyond are left to their destructors.
struct Slot {
  std::atomic<bool> taken = false;
  std::atomic<bool> holds_file = false;
  std::array<char, PATH_MAX> path{};
};
constexpr int kNumSlots = 256;
std::array<Slot, kNumSlots> slots;

constexpr std::array kEndingSignals = {SIGINT,  SIGTERM, SIGHUP, SIGQUIT,
                                       SIGPIPE, SIGXCPU, SIGXFSZ};

extern "C" void RemoveFilesAndEnd(int signal) {
  for (const Slot& slot : slots) {
    if (slot.holds_file) ::unlink(slot.path.data());
  }
  std::signal(signal, SIG_DFL);
  ::raise(signal);  // Ends the process when this handler returns.
}

void TakeEndingSignals() {
  for (const int signal : kEndingSignals) {
    struct sigaction now = {};
    if (::sigaction(signal, nullptr, &now) != 0) continue;
    if (now.sa_handler != SIG_DFL) continue;
    struct sigaction ours = {};
    ours.sa_handler = RemoveFilesAndEnd;
    sigfillset(&ours.sa_mask);
    ::sigaction(signal, &ours, nullptr);
  }
}

int TakeSlot(const std::string& path) {
  if (path.size() >= PATH_MAX) return -1;
  for (int i = 0; i < kNumSlots; ++i) {
    Slot& slot = slots[static_cast<std::size_t>(i)];
    if (slot.taken.exchange(true)) continue;
    std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
    slot.holds_file = true;
    return i;
  }
  return -1;
}

void FreeSlot(int number) {
  if (number < 0) return;
  Slot& slot = slots[static_cast<std::size_t>(number)];
  slot.holds_file = false;
  slot.taken = false;
}

// Leaves room for the ending in the 255 bytes that a file name may have.
constexpr std::size_t kMaxStem = 200;

std::string NextName(const std::string& path) {
  static std::atomic<unsigned> count = 0;
  const std::filesystem::path whole(path);
  const std::string stem = whole.filename().string().substr(0, kMaxStem);
  const std::string name = stem + ".part-" + std::to_string(::getpid()) + "-" +
                           std::to_string(++count);
  return (whole.parent_path() / name).string();
}

}  // namespace

Result<TemporaryFile> TemporaryFile::Create(const std::string& path,
                                            unsigned mode) {
  static std::once_flag once;
  std::call_once(once, TakeEndingSignals);
  for (;;) {
    const std::string name = NextName(path);
    const int fd =
        ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (fd >= 0) return TemporaryFile(name, TakeSlot(name), fd);
    // Left by a killed process that had our number.
    if (errno == EEXIST) continue;
    return Error{ErrorCode::kUnavailable, std::strerror(errno)};
  }
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      slot_(std::exchange(other.slot_, -1)),
      fd_(std::exchange(other.fd_, -1)) {}

TemporaryFile::~TemporaryFile() {
  Remove();
}

Status TemporaryFile::RenameTo(const std::string& path) {
  // A disk may refuse late: with the last byte, or only when the file is closed
  // (quotas, network folders).
  if (::close(std::exchange(fd_, -1)) != 0 ||
      ::rename(path_.c_str(), path.c_str()) != 0) {
    const Error error{ErrorCode::kUnavailable, std::strerror(errno)};
    Remove();
    return error;
  }
  path_.clear();
  FreeSlot(std::exchange(slot_, -1));
  return Done{};
}

void TemporaryFile::Remove() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  if (!path_.empty()) ::unlink(std::exchange(path_, {}).c_str());
  FreeSlot(std::exchange(slot_, -1));
}

}  // namespace terra

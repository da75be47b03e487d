#include "tests/support/unread_output.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace terra::testing {
namespace {

constexpr int kPipeBytes = 4096;

void Require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

void OpenPipe(int& reader, int& writer) {
  std::array<int, 2> ends{};
  Require(pipe2(ends.data(), O_CLOEXEC) == 0, "no pipe");
  reader = ends[0];
  writer = ends[1];
  fcntl(writer, F_SETPIPE_SZ, kPipeBytes);
}

void OpenTerminal(int& reader, int& writer) {
  reader = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  Require(reader >= 0 && grantpt(reader) == 0 && unlockpt(reader) == 0,
          "no terminal");
  writer = open(ptsname(reader), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  Require(writer >= 0, "no terminal");
}

// One byte at a time: a larger write needs more room than may be left.
void Fill(int writer) {
  const int flags = fcntl(writer, F_GETFL);
  fcntl(writer, F_SETFL, flags | O_NONBLOCK);
  while (write(writer, ".", 1) == 1) {
  }
  fcntl(writer, F_SETFL, flags);
}

}  // namespace

UnreadOutput::UnreadOutput(Kind kind) {
  if (kind == Kind::kPipe) {
    OpenPipe(reader_, writer_);
  } else {
    OpenTerminal(reader_, writer_);
  }
  Fill(writer_);
}

UnreadOutput::~UnreadOutput() {
  close(writer_);
  close(reader_);
}

std::vector<std::string> UnreadOutput::AsStandardErrorOf() const {
  const std::string path =
      "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(writer_);
  return {"sh", "-c", "exec \"$@\" 2>>" + path, "sh"};
}

std::string UnreadOutput::Read(std::chrono::milliseconds at_most) {
  std::string text;
  pollfd readable{reader_, POLLIN, 0};
  std::array<char, kPipeBytes> part{};
  for (int wait = static_cast<int>(at_most.count());
       poll(&readable, 1, wait) == 1; wait = 0) {
    const ssize_t got = read(reader_, part.data(), part.size());
    if (got <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  return text;
}

}  // namespace terra::testing

#include "output/standard_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

namespace terra {
namespace {

Error OutputLost(const std::string& reason) {
  return {ErrorCode::kUnavailable,
          "standard output cannot be written: " + reason};
}

}  // namespace

void ReserveStandardStreams() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd) {
    if (::fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
    // The wrong direction on purpose: every use fails. The lowest free number
    // is given, which is this one. Inherited by children as it is.
    const int wrong = fd == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", wrong) < 0) return;
  }
}

Status FlushStandardOutput() {
  // std::cout has no buffer of its own: it writes into stdout's.
  std::cout.flush();
  if (std::fflush(stdout) != 0) return OutputLost(std::strerror(errno));
  if (std::ferror(stdout) != 0 || !std::cout) {
    return OutputLost("a part of it was lost");
  }
  return Done{};
}

int FinishStandardOutput(const char* program, int exit_code) {
  Status written = FlushStandardOutput();
  // Some systems tell only at the close what they could not keep (quotas,
  // network folders); closing a second descriptor asks them as well.
  const int copy = written.ok() ? ::dup(STDOUT_FILENO) : -1;
  if (copy >= 0 && ::close(copy) != 0 && errno != EINTR) {
    written = OutputLost(std::strerror(errno));
  }
  if (written.ok()) return exit_code;
  std::cerr << program << ": " << written.error().message << "\n";
  return exit_code == 0 ? 1 : exit_code;
}

}  // namespace terra

#include "tests/support/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>

namespace terra::testing {
namespace {

using std::chrono::milliseconds;

// As a shell finds it.
std::string FindProgram(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = folder + "/" + name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return name;
}

// In the child, between fork and exec: only async-signal-safe calls.
[[noreturn]] void Exec(char* const* arguments, int output_fd) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(output_fd, STDOUT_FILENO);
  ::dup2(output_fd, STDERR_FILENO);
  ::execv(arguments[0], arguments);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command) {
  const std::string program = FindProgram(command.front());
  if (::access(program.c_str(), X_OK) != 0) {
    throw std::runtime_error("no such program: " + program);
  }
  std::vector<char*> arguments = {const_cast<char*>(program.c_str())};
  for (std::size_t i = 1; i < command.size(); ++i) {
    arguments.push_back(const_cast<char*>(command[i].c_str()));
  }
  arguments.push_back(nullptr);
  output_fd_ = ::memfd_create("output", MFD_CLOEXEC);
  // Appending, so that what the program's own children write is kept too.
  ::fcntl(output_fd_, F_SETFL, O_APPEND);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) Exec(arguments.data(), output_fd_);
  pid_fd_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
}

ChildProcess::~ChildProcess() {
  Kill();
  ::close(pid_fd_);
  ::close(output_fd_);
}

void ChildProcess::Signal(int signal) const {
  if (!exit_code_) ::kill(pid_, signal);
}

std::optional<int> ChildProcess::WaitForExit(milliseconds at_most) {
  if (exit_code_) return exit_code_;
  pollfd ended{pid_fd_, POLLIN, 0};
  if (::poll(&ended, 1, static_cast<int>(at_most.count())) <= 0) return {};
  int status = 0;
  rusage used{};
  ::wait4(pid_, &status, 0, &used);
  peak_kilobytes_ = used.ru_maxrss;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return exit_code_;
}

int ChildProcess::Terminate() {
  Signal(SIGTERM);
  const std::optional<int> code = WaitForExit(milliseconds(10'000));
  if (!code) Kill();
  return code.value_or(-1);
}

void ChildProcess::Kill() {
  Signal(SIGKILL);
  WaitForExit(milliseconds(-1));
}

bool ChildProcess::WaitForOutput(const std::string& text,
                                 milliseconds at_most) {
  const auto give_up = std::chrono::steady_clock::now() + at_most;
  bool ended = false;
  while (true) {
    if (output().find(text) != std::string::npos) return true;
    if (ended || std::chrono::steady_clock::now() > give_up) return false;
    // A file has no event for being written to, so this looks again and again.
    ended = WaitForExit(milliseconds(5)).has_value();
  }
}

std::string ChildProcess::output() const {
  std::string text;
  char buffer[4096];
  off_t offset = 0;
  while (true) {
    const ssize_t n = ::pread(output_fd_, buffer, sizeof buffer, offset);
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
    offset += n;
  }
}

RunResult RunToEnd(const std::vector<std::string>& command) {
  ChildProcess process(command);
  const std::optional<int> code =
      process.WaitForExit(std::chrono::seconds(150));
  return {code.value_or(-1), process.output(), process.peak_kilobytes()};
}

std::string ProgramPath(const std::string& name) {
  return std::string(TERRA_PROGRAM_FOLDER) + "/" + name;
}

}  // namespace terra::testing

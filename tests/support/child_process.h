#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace terra::testing {

/// A program that a test runs. It dies with the test, whatever happens.
class ChildProcess {
 public:
  /// Starts it, looked for in PATH when its name has no slash; its output goes
  /// to a file of its own, read by output().
  /// Errors: std::runtime_error when there is no such program.
  explicit ChildProcess(const std::vector<std::string>& command);
  /// Kills it if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal) const;

  /// Waits for its end. Returns the exit code, 128 + n when signal n ended it;
  /// nothing when it still runs after the time.
  std::optional<int> WaitForExit(std::chrono::milliseconds at_most);
  bool running() { return !WaitForExit(std::chrono::milliseconds(0)); }

  /// SIGTERM and its exit code; -1 and SIGKILL when that takes over 10 s.
  int Terminate();
  /// SIGKILL, and it is gone on return.
  void Kill();

  /// Waits until it has written this; false when it ended without, or after
  /// the time.
  bool WaitForOutput(const std::string& text,
                     std::chrono::milliseconds at_most);
  /// What it wrote so far to standard output and error.
  std::string output() const;

  /// The most memory it had resident, in kB; 0 until it has ended.
  long peak_kilobytes() const { return peak_kilobytes_; }

 private:
  pid_t pid_ = -1;
  int pid_fd_ = -1;
  int output_fd_ = -1;
  std::optional<int> exit_code_;
  long peak_kilobytes_ = 0;
};

/// Runs a program to its end and returns its exit code and output.
struct RunResult {
  int exit_code = -1;
  std::string output;
  long peak_kilobytes = 0;  ///< Resident; at least what this process has.
};
RunResult RunToEnd(const std::vector<std::string>& command);

/// The path of one of the project's programs: "terra-planner".
std::string ProgramPath(const std::string& name);

}  // namespace terra::testing

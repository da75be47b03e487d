#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace terra::testing {

/// A pipe or a terminal that is full and that nobody reads: whoever writes to
/// it waits until somebody does.
class UnreadOutput {
 public:
  enum class Kind { kPipe, kTerminal };
  /// Errors: std::runtime_error when the system gives none.
  explicit UnreadOutput(Kind kind);
  ~UnreadOutput();
  UnreadOutput(const UnreadOutput&) = delete;
  UnreadOutput& operator=(const UnreadOutput&) = delete;

  /// To be put in front of a command: its standard error goes here.
  std::vector<std::string> AsStandardErrorOf() const;

  /// Waits until there is something to read and reads all of that, so that
  /// writers go on. Nothing after the time.
  std::string Read(std::chrono::milliseconds at_most);

 private:
  int reader_ = -1;
  int writer_ = -1;
};

}  // namespace terra::testing

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace terra::testing {

/// How often a text holds another.
int TimesIn(const std::string& text, const std::string& what);

/// What this process writes to standard error while the object lives: the log's
/// lines, which a thread of the log's own writes some time after they were
/// logged, and those of libraries. One at a time.
class CapturedErrors {
 public:
  CapturedErrors();
  ~CapturedErrors();
  CapturedErrors(const CapturedErrors&) = delete;
  CapturedErrors& operator=(const CapturedErrors&) = delete;

  /// Waits until `what` was written `times` times. Returns false if that took
  /// longer than 20 s.
  bool Await(const std::string& what, int times = 1);
  /// How often `what` was written so far.
  int Times(const std::string& what);
  /// What was written so far.
  std::string Text();

 private:
  void Read();

  int standard_error_ = -1;  // The one of before.
  int read_end_ = -1;
  std::mutex mutex_;
  std::condition_variable grown_;
  std::string text_;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace terra::testing

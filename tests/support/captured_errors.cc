#include "tests/support/captured_errors.h"

#include <unistd.h>

#include <array>
#include <chrono>

#include <gtest/gtest.h>

namespace terra::testing {

int TimesIn(const std::string& text, const std::string& what) {
  int times = 0;
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + 1)) {
    ++times;
  }
  return times;
}

CapturedErrors::CapturedErrors() : standard_error_(dup(STDERR_FILENO)) {
  std::array<int, 2> ends{};
  if (standard_error_ < 0 || pipe(ends.data()) != 0) {
    ADD_FAILURE() << "standard error cannot be captured";
    return;
  }
  read_end_ = ends[0];
  dup2(ends[1], STDERR_FILENO);
  close(ends[1]);
  thread_ = std::thread(&CapturedErrors::Read, this);
}

// Standard error was the last writing end of the pipe: the reader ends.
CapturedErrors::~CapturedErrors() {
  dup2(standard_error_, STDERR_FILENO);
  if (thread_.joinable()) thread_.join();
  close(standard_error_);
  close(read_end_);
}

void CapturedErrors::Read() {
  std::array<char, 4096> part{};
  ssize_t size = 0;
  while ((size = read(read_end_, part.data(), part.size())) > 0) {
    const std::lock_guard lock(mutex_);
    text_.append(part.data(), static_cast<std::size_t>(size));
    grown_.notify_all();
  }
}

bool CapturedErrors::Await(const std::string& what, int times) {
  std::unique_lock lock(mutex_);
  return grown_.wait_for(lock, std::chrono::seconds(20), [&] {
    return TimesIn(text_, what) >= times;
  });
}

int CapturedErrors::Times(const std::string& what) {
  const std::lock_guard lock(mutex_);
  return TimesIn(text_, what);
}

std::string CapturedErrors::Text() {
  const std::lock_guard lock(mutex_);
  return text_;
}

}  // namespace terra::testing

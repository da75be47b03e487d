#include "benchmark/progress.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace terra::benchmark {
namespace {

constexpr std::chrono::milliseconds kTerminalPeriod{500};
constexpr std::chrono::seconds kLinePeriod{30};

}  // namespace

std::string FormatDuration(double seconds) {
  const auto s = static_cast<std::int64_t>(std::ceil(seconds));
  if (s < 60) return std::to_string(s) + " s";
  if (s < 3600) {
    return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
  }
  return std::to_string(s / 3600) + " h " + std::to_string(s % 3600 / 60) +
         " min";
}

Progress::Progress(std::string title, std::int64_t total, std::int64_t done)
    : title_(std::move(title)),
      total_(total),
      resumed_(done),
      begin_(Clock::now()),
      terminal_(::isatty(STDERR_FILENO) == 1),
      done_(done),
      next_print_(begin_ + (terminal_ ? kTerminalPeriod : kLinePeriod)) {}

Progress::~Progress() {
  if (!printed_) return;
  Print(Clock::now());
  if (terminal_) std::fputc('\n', stderr);
}

void Progress::Advance() {
  const Clock::time_point now = Clock::now();
  const std::scoped_lock lock(mutex_);
  ++done_;
  if (now < next_print_) return;
  next_print_ = now + (terminal_ ? kTerminalPeriod : kLinePeriod);
  Print(now);
}

void Progress::Print(Clock::time_point now) {
  printed_ = true;
  const double took = std::chrono::duration<double>(now - begin_).count();
  const double rate = static_cast<double>(done_ - resumed_) / took;
  std::array<char, 64> figures{};
  std::snprintf(figures.data(), figures.size(), "%lld of %lld, %.3g/s, ",
                static_cast<long long>(done_), static_cast<long long>(total_),
                rate);
  const std::string left =
      done_ == total_ ? "took " + FormatDuration(took)
      : rate > 0
          ? FormatDuration(static_cast<double>(total_ - done_) / rate) + " left"
          : "time left unknown";
  std::fprintf(stderr, terminal_ ? "\r%s: %s%s\033[K" : "%s: %s%s\n",
               title_.c_str(), figures.data(), left.c_str());
  std::fflush(stderr);
}

}  // namespace terra::benchmark

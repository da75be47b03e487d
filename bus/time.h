#pragma once

#include <chrono>
#include <cstdint>

namespace terra::bus {

/// The receiver's own monotonic clock: freshness and periods are judged by it,
/// never by a sender's stamp.
using Clock = std::chrono::steady_clock;
using Time = Clock::time_point;
using Duration = Clock::duration;

inline constexpr Time kNever = Time::max();

/// Returns microseconds of the monotonic clock.
inline std::int64_t MonotonicMicroseconds(Time time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             time.time_since_epoch())
      .count();
}

/// State on the bus is repeated this often while it is current; advice and
/// heartbeats every second.
inline constexpr Duration kStatePeriod = std::chrono::milliseconds(200);
inline constexpr Duration kSlowPeriod = std::chrono::seconds(1);

/// Says when something periodic is due. Missed periods are not made up for.
class Periodic {
 public:
  explicit Periodic(Duration period) : period_(period) {}

  /// Due at once.
  void Restart() { next_ = Time::min(); }
  void Stop() { next_ = kNever; }
  /// Starts a full period from now: something was just done out of turn.
  void Postpone(Time now) { next_ = now + period_; }

  /// Returns whether it is due, and if so waits for the next period.
  bool Due(Time now) {
    if (now < next_) return false;
    next_ = now + period_;
    return true;
  }
  Time next() const { return next_; }

 private:
  Duration period_;
  Time next_ = Time::min();
};

}  // namespace terra::bus

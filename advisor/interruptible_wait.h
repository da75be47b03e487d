#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace terra::advisor {

/// Waits; returns false at once when asked to stop.
inline bool WaitUnlessStopped(double seconds, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop, std::chrono::duration<double>(seconds), [] {
    return false;
  });
  return !stop.stop_requested();
}

}  // namespace terra::advisor

#include "benchmark/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace terra::benchmark {

int NumJobs(int jobs) {
  if (jobs > 0) return jobs;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void ParallelFor(std::int64_t count, int jobs,
                 const std::function<void(std::int64_t)>& work) {
  std::atomic<std::int64_t> next{0};
  std::mutex mutex;
  // Of the first piece that failed, not of the first to fail: all pieces before
  // it are taken and done.
  std::exception_ptr failure;
  std::int64_t failed = count;
  const auto run = [&] {
    std::int64_t i = 0;
    try {
      for (i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      const std::scoped_lock lock(mutex);
      if (i < failed) {
        failed = i;
        failure = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::int64_t others = std::min<std::int64_t>(NumJobs(jobs), count);
    for (std::int64_t i = 1; i < others; ++i) threads.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace terra::benchmark

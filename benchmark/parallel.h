#pragma once

#include <cstdint>
#include <functional>

namespace terra::benchmark {

/// Returns how many threads to use: `jobs`, or all cores when it is 0.
int NumJobs(int jobs);

/// Calls work(0) ... work(count - 1), each once, from `jobs` threads (0 = all
/// cores). Indices are handed out in order, so a later one may end earlier.
///
/// An exception of a call stops the handing out. When all threads have ended,
/// that of the lowest index is thrown here, however the threads were timed.
/// Threads: `work` is called from several at a time.
void ParallelFor(std::int64_t count, int jobs,
                 const std::function<void(std::int64_t)>& work);

}  // namespace terra::benchmark

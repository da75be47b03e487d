#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "benchmark/parallel.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// How many items per thread may be under way beyond one that takes longer:
/// what is kept in memory, and what a kill at the worst moment throws away.
inline constexpr int kItemsAhead = 32;

/// Works on items side by side and takes what comes of them in their order.
/// The number of items that are in memory is bounded.
template <typename Item, typename Outcome>
class OrderedPipeline {
 public:
  /// The next item; none at the end, and then it is not called again.
  /// Threads: of one at a time.
  using Next = std::function<Result<std::optional<Item>>()>;
  /// Threads: called from several at a time.
  using Work = std::function<Result<Outcome>(const Item&)>;
  /// Threads: of one at a time, in order of the items.
  using Take = std::function<Status(Outcome)>;

  OrderedPipeline(Next next, Work work, Take take)
      : next_(std::move(next)),
        work_(std::move(work)),
        take_(std::move(take)) {}

  /// Runs to the end on so many threads (0 = all cores); once. The first error
  /// or exception ends it when what is under way is done; what comes before the
  /// item that failed is still taken.
  Status Run(int jobs) {
    const int threads = NumJobs(jobs);
    window_ = std::int64_t{threads} * kItemsAhead;
    {
      std::vector<std::jthread> others;
      for (int i = 1; i < threads; ++i) {
        others.emplace_back([this] {
          RunThread();
        });
      }
      RunThread();
    }
    if (thrown_) std::rethrow_exception(thrown_);
    if (failure_) return *failure_;
    return Done{};
  }

 private:
  void RunThread() {
    try {
      while (Step()) {
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
      Stop();
    }
  }

  // One item; false when there is nothing left to do.
  bool Step() {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [this] {
      return ended_ || num_begun_ < num_taken_ + window_;
    });
    if (ended_) return false;
    Result<std::optional<Item>> item = next_();
    if (!item.ok()) return Fail(item.error());
    if (!item->has_value()) return Stop();
    const std::int64_t number = num_begun_++;
    lock.unlock();
    Result<Outcome> outcome = work_(**item);
    lock.lock();
    if (!outcome.ok()) return Fail(outcome.error());
    outcomes_.emplace(number, *std::move(outcome));
    return TakeOutcomes();
  }

  // Those whose turn it is.
  bool TakeOutcomes() {
    for (auto first = outcomes_.begin();
         first != outcomes_.end() && first->first == num_taken_;
         first = outcomes_.erase(first)) {
      const Status taken = take_(std::move(first->second));
      if (!taken.ok()) {
        outcomes_.erase(first);  // Its turn stays, so nothing follows it.
        return Fail(taken.error());
      }
      ++num_taken_;
    }
    room_.notify_all();
    return true;
  }

  bool Fail(const Error& error) {
    if (!failure_) failure_ = error;
    return Stop();
  }

  // No thread begins another item.
  bool Stop() {
    ended_ = true;
    room_.notify_all();
    return false;
  }

  const Next next_;
  const Work work_;
  const Take take_;
  std::int64_t window_ = 0;
  std::mutex mutex_;
  std::condition_variable room_;
  std::int64_t num_begun_ = 0;
  std::int64_t num_taken_ = 0;
  std::map<std::int64_t, Outcome> outcomes_;  ///< Of those not yet taken.
  bool ended_ = false;
  std::optional<Error> failure_;
  std::exception_ptr thrown_;
};

}  // namespace terra::benchmark

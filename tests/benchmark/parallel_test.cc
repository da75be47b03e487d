#include "benchmark/parallel.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "benchmark/progress.h"

namespace terra::benchmark {
namespace {

TEST(ParallelFor, CallsEveryIndexOnce) {
  for (const int jobs : {1, 2, 7}) {
    std::vector<std::atomic<int>> calls(1000);
    ParallelFor(1000, jobs, [&](std::int64_t i) {
      ++calls[static_cast<std::size_t>(i)];
    });
    for (const auto& n : calls) ASSERT_EQ(n, 1) << jobs;
  }
}

TEST(ParallelFor, NothingToDoCallsNothing) {
  ParallelFor(0, 4, [](std::int64_t) {
    FAIL();
  });
}

TEST(ParallelFor, AnExceptionEndsTheWorkAndIsThrown) {
  std::atomic<int> calls{0};
  EXPECT_THROW(ParallelFor(1'000'000, 3,
                           [&](std::int64_t i) {
                             ++calls;
                             if (i == 10) throw std::runtime_error("ten");
                           }),
               std::runtime_error);
  EXPECT_LT(calls, 1'000'000);
}

// Every other piece fails; the first one is the slowest.
TEST(ParallelFor, WhichExceptionIsThrownDependsOnNoThread) {
  std::atomic<int> later_failures{0};
  const auto work = [&](std::int64_t i) {
    if (i % 2 == 1) return;
    if (i == 0) {
      while (later_failures == 0) std::this_thread::yield();
    } else {
      ++later_failures;
    }
    throw std::runtime_error(std::to_string(i));
  };
  try {
    ParallelFor(1000, 4, work);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "0");
  }
}

TEST(FormatDuration, NamesTheTwoLargestUnits) {
  EXPECT_EQ(FormatDuration(0.2), "1 s");
  EXPECT_EQ(FormatDuration(200), "3 min 20 s");
  EXPECT_EQ(FormatDuration(7500), "2 h 5 min");
}

}  // namespace
}  // namespace terra::benchmark

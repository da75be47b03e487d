#include "benchmark/parallel.h"

#include <atomic>
#include <stdexcept>
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

TEST(FormatDuration, NamesTheTwoLargestUnits) {
  EXPECT_EQ(FormatDuration(0.2), "1 s");
  EXPECT_EQ(FormatDuration(200), "3 min 20 s");
  EXPECT_EQ(FormatDuration(7500), "2 h 5 min");
}

}  // namespace
}  // namespace terra::benchmark

#include "benchmark/ordered_pipeline.h"

#include <atomic>
#include <semaphore>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;

// The numbers from 0 on.
class Counter {
 public:
  explicit Counter(int end) : end_(end) {}
  Result<std::optional<int>> operator()() {
    if (*next_ == end_) return std::optional<int>();
    return std::optional((*next_)++);
  }
  int begun() const { return *next_; }

 private:
  int end_;
  std::shared_ptr<int> next_ = std::make_shared<int>(0);
};

TEST(OrderedPipeline, TakesWhatIsDoneSideBySideInOrderOfTheItems) {
  constexpr int kItems = 2000;
  std::vector<int> taken;
  std::vector<int> expected;
  for (int i = 0; i < kItems; ++i) expected.push_back(2 * i);
  OrderedPipeline<int, int> work(
      Counter(kItems),
      [](const int& i) -> Result<int> {
        if (i % 7 == 0) std::this_thread::yield();
        return 2 * i;
      },
      [&](int outcome) -> Status {
        taken.push_back(outcome);
        return Done{};
      });
  ASSERT_TRUE(work.Run(4).ok());
  EXPECT_EQ(taken, expected);
}

TEST(OrderedPipeline, OneThatTakesLongHoldsUpABoundedNumber) {
  constexpr int kJobs = 2;
  const Counter counter(1000);
  std::atomic<int> others = 0;
  std::binary_semaphore window_is_full{0};
  int most = 0;
  OrderedPipeline<int, int> work(
      counter,
      [&](const int& i) -> Result<int> {
        if (i == 0) {
          window_is_full.acquire();
        } else if (++others == kJobs * kItemsAhead - 1) {
          window_is_full.release();
        }
        return i;
      },
      [&](int outcome) -> Status {
        most = std::max(most, counter.begun() - outcome);
        return Done{};
      });
  ASSERT_TRUE(work.Run(kJobs).ok());
  EXPECT_EQ(most, kJobs * kItemsAhead);
}

TEST(OrderedPipeline, WhatComesBeforeAFaultIsTakenAndNothingAfter) {
  for (const int jobs : {1, 3}) {
    std::vector<int> taken;
    OrderedPipeline<int, int> work(
        Counter(100),
        [](const int& i) -> Result<int> {
          if (i == 5) return Error{ErrorCode::kInvalid, "five"};
          return i;
        },
        [&](int outcome) -> Status {
          taken.push_back(outcome);
          return Done{};
        });
    EXPECT_EQ(ErrorMessage(work.Run(jobs)), "five");
    EXPECT_THAT(taken, ::testing::ElementsAre(0, 1, 2, 3, 4));
  }
}

TEST(OrderedPipeline, AFaultOfTakingEndsIt) {
  std::vector<int> taken;
  OrderedPipeline<int, int> work(
      Counter(100),
      [](const int& i) -> Result<int> {
        return i;
      },
      [&](int outcome) -> Status {
        if (outcome == 3) return Error{ErrorCode::kUnavailable, "full"};
        taken.push_back(outcome);
        return Done{};
      });
  EXPECT_EQ(ErrorMessage(work.Run(2)), "full");
  EXPECT_THAT(taken, ::testing::ElementsAre(0, 1, 2));
}

TEST(OrderedPipeline, AFaultOfTheItemsEndsIt) {
  int calls = 0;
  OrderedPipeline<int, int> work(
      [&]() -> Result<std::optional<int>> {
        if (++calls == 4) return Error{ErrorCode::kInvalid, "line 4"};
        return std::optional(calls);
      },
      [](const int& i) -> Result<int> {
        return i;
      },
      [](int) -> Status {
        return Done{};
      });
  EXPECT_EQ(ErrorMessage(work.Run(2)), "line 4");
  EXPECT_EQ(calls, 4);
}

TEST(OrderedPipeline, AnExceptionIsThrownWhenAllThreadsHaveEnded) {
  OrderedPipeline<int, int> work(
      Counter(100),
      [](const int& i) -> Result<int> {
        if (i == 50) throw std::runtime_error("fifty");
        return i;
      },
      [](int) -> Status {
        return Done{};
      });
  EXPECT_THROW(static_cast<void>(work.Run(3)), std::runtime_error);
}

}  // namespace
}  // namespace terra::benchmark

// Fair shares of judging: by counting steps, without a clock.
#include "verifier/advice_queue.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "verifier/verify.h"

namespace terra::verifier {
namespace {

constexpr std::int64_t kSecond = 1'000'000;
constexpr AdviceQueue::Limits kLimits;

// A proposal of so many steps; the sender is written into its session.
AdviceEvent Proposal(SenderId sender, std::int64_t attempt, int steps) {
  AdviceEvent event;
  event.session = static_cast<std::int64_t>(sender);
  event.attempt = attempt;
  event.kind = AdviceKind::kPropose;
  event.waypoints = {{0, 0}, {steps, 0}};
  return event;
}

// As many bytes as fit a message, as many steps as are walked at most.
AdviceEvent Maximal(SenderId sender, std::int64_t attempt) {
  AdviceEvent event = Proposal(sender, attempt, 0);
  event.waypoints.assign(2'048, {0, 0});
  for (std::size_t i = 1; i < event.waypoints.size(); i += 2) {
    event.waypoints[i].x = 40;
  }
  event.advisor.assign(60'000 - 2'048 * sizeof(Cell), 'a');
  return event;
}

// All that can be handed out at this time.
std::vector<AdviceEvent> Drain(AdviceQueue& queue, std::int64_t now_us) {
  std::vector<AdviceEvent> events;
  while (auto event = queue.Next(now_us)) events.push_back(*std::move(event));
  return events;
}

TEST(StepsToJudge, AreThoseOfTheRasterWithinTheLimitsOfTheBus) {
  EXPECT_EQ(StepsToJudge({}), 0);
  EXPECT_EQ(StepsToJudge({{3, 4}}), 0);
  EXPECT_EQ(StepsToJudge({{0, 0}, {3, -4}, {3, 0}}), 8);
  constexpr int kLow = std::numeric_limits<int>::min();
  constexpr int kHigh = std::numeric_limits<int>::max();
  EXPECT_EQ(StepsToJudge(Route(2'048, Cell{kLow, kHigh})), 0);
  EXPECT_EQ(StepsToJudge({{kLow, kLow}, {kHigh, kHigh}, {kLow, kHigh}}),
            kBusLimits.max_steps);
  EXPECT_EQ(StepsToJudge(Maximal(1, 1).waypoints), kBusLimits.max_steps);
  EXPECT_EQ(StepsToJudge(Route(2'049, Cell{})), 0) << "is not walked";
}

TEST(AdviceQueueTest, OfOneSenderTheShortestComesFirst) {
  AdviceQueue queue;
  for (const int steps : {300, 100, 200, 100}) {
    queue.Add(1, Proposal(1, static_cast<std::int64_t>(queue.size()), steps));
  }
  std::vector<int> steps;
  std::vector<std::int64_t> attempts;
  for (const AdviceEvent& event : Drain(queue, 0)) {
    steps.push_back(event.waypoints[1].x);
    attempts.push_back(event.attempt);
  }
  EXPECT_EQ(steps, (std::vector<int>{100, 100, 200, 300}));
  EXPECT_EQ(attempts, (std::vector<std::int64_t>{1, 3, 2, 0}))
      << "equal ones in order of arrival";
}

TEST(AdviceQueueTest, WhatWaitsAlreadyIsLeftOut) {
  AdviceQueue queue;
  for (int i = 0; i < 3; ++i) queue.Add(1, Proposal(1, 5, 100));
  EXPECT_EQ(queue.size(), 1u);
  EXPECT_EQ(queue.dropped(), 0);
  queue.Add(2, Proposal(1, 5, 100));
  EXPECT_EQ(queue.size(), 2u) << "another sender's is another one";
}

TEST(AdviceQueueTest, AProposalThatIsNotOneIsNotPaidForByItsRoute) {
  AdviceQueue queue;
  AdviceEvent retain = Maximal(1, 1);
  retain.kind = AdviceKind::kRetain;
  queue.Add(1, retain);
  queue.Add(1, Proposal(1, 2, 1));
  const auto first = queue.Next(0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, AdviceKind::kRetain);
}

TEST(AdviceQueueTest, AfterItsBurstItHandsOutWhatTheBudgetAllows) {
  AdviceQueue queue;
  std::int64_t attempt = 0;
  const auto fill = [&] {
    for (SenderId sender = 0; sender < 300; ++sender) {
      queue.Add(sender, Maximal(sender, ++attempt));
    }
  };
  fill();
  EXPECT_EQ(Drain(queue, 0).size(), 12u) << "1,000,000 / 80,000";
  std::size_t in_a_second = 0;
  for (std::int64_t now = 1'000; now <= kSecond; now += 1'000) {
    in_a_second += Drain(queue, now).size();
    fill();
  }
  EXPECT_EQ(in_a_second, 125u) << "10,000,000 / 80,000, and a rest of 40,000";
}

TEST(AdviceQueueTest, NextTimeIsExact) {
  AdviceQueue queue;
  EXPECT_EQ(queue.next_us(), AdviceQueue::kNever);
  std::int64_t now = 77;
  std::int64_t attempt = 0;
  queue.Add(1, Proposal(1, ++attempt, 1));
  while (queue.Next(now)) queue.Add(1, Maximal(1, ++attempt));
  ASSERT_GT(queue.next_us(), now);
  EXPECT_FALSE(queue.Next(queue.next_us() - 1));
  now = queue.next_us();
  EXPECT_TRUE(queue.Next(now));
  EXPECT_EQ(queue.next_us(), AdviceQueue::kNever);
}

TEST(AdviceQueueTest, AClockThatRunsBackGivesNoBudget) {
  AdviceQueue queue;
  std::int64_t attempt = 0;
  queue.Add(1, Maximal(1, ++attempt));
  while (queue.Next(kSecond)) queue.Add(1, Maximal(1, ++attempt));
  EXPECT_FALSE(queue.Next(0));
  EXPECT_FALSE(queue.Next(std::numeric_limits<std::int64_t>::min()));
  EXPECT_FALSE(queue.Next(kSecond));
}

TEST(AdviceQueueTest, TheSizeOfTheTableIsItsBound) {
  AdviceQueue queue;
  for (SenderId sender = 0; sender < 2 * kLimits.senders; ++sender) {
    queue.Add(sender, Maximal(sender, 1));
  }
  EXPECT_EQ(queue.num_senders(), kLimits.senders);
  EXPECT_EQ(queue.dropped(), static_cast<std::int64_t>(kLimits.senders));
}

TEST(AdviceQueueTest, WhatNoMessageCanHoldIsDropped) {
  AdviceQueue queue;
  AdviceEvent event = Proposal(1, 1, 1);
  event.advisor.assign(kLimits.bytes_of_sender, 'a');
  queue.Add(1, event);
  EXPECT_EQ(queue.num_senders(), 0u);
  EXPECT_EQ(queue.next_us(), AdviceQueue::kNever);
  EXPECT_EQ(queue.dropped(), 1);
}

// However 256 others fill their queues, one that comes last waits for less than
// 3 s of the budget.
TEST(AdviceQueueTest, With256HostileSendersAnHonestOneIsJudgedWithin3Seconds) {
  constexpr SenderId kHonest = 1'000;
  constexpr int kHostile = 256;
  AdviceQueue queue;
  std::int64_t attempt = 0;
  for (int round = 0; round < 30; ++round) {
    for (SenderId sender = 0; sender < kHostile; ++sender) {
      queue.Add(sender, Maximal(sender, ++attempt));
    }
  }
  std::int64_t now = 0;
  Drain(queue, now);  // the burst is spent
  queue.Add(kHonest, Maximal(kHonest, 1));
  std::int64_t steps = 0;
  while (true) {
    now = queue.next_us();
    const auto event = queue.Next(now);
    ASSERT_TRUE(event);
    steps += StepsToJudge(event->waypoints);
    if (event->session == static_cast<std::int64_t>(kHonest)) break;
    queue.Add(static_cast<SenderId>(event->session),
              Maximal(static_cast<SenderId>(event->session), ++attempt));
  }
  EXPECT_LE(steps, (kHostile + 1) * kBusLimits.max_steps);
  EXPECT_LE(now, 3 * kSecond);
}

struct Sent {
  SenderId sender;
  AdviceEvent advice;
};

std::vector<Sent> AnyMessages() {
  std::vector<Sent> messages;
  std::int64_t attempt = 0;
  for (const auto& [sender, steps] :
       *rc::gen::container<std::vector<std::pair<int, int>>>(
           rc::gen::pair(rc::gen::inRange(0, 6), rc::gen::inRange(-1, 5)))) {
    const auto id = static_cast<SenderId>(sender);
    ++attempt;
    messages.push_back({id, steps < 0 ? Maximal(id, attempt)
                                      : Proposal(id, attempt, 10'000 * steps)});
  }
  return messages;
}

RC_GTEST_PROP(AdviceQueueProperty, MemoryIsBoundedAndTheNewestAlwaysFits, ()) {
  AdviceQueue queue;
  std::map<SenderId, AdviceEvent> newest;
  for (const Sent& sent : AnyMessages()) {
    queue.Add(sent.sender, sent.advice);
    newest[sent.sender] = sent.advice;
    RC_ASSERT(queue.num_senders() == newest.size());
    RC_ASSERT(queue.size() <= newest.size() * kLimits.messages_of_sender);
    RC_ASSERT(queue.bytes() <= newest.size() * kLimits.bytes_of_sender);
  }
  std::vector<AdviceEvent> out;
  for (std::int64_t now = queue.next_us(); queue.size() > 0;
       now = queue.next_us()) {
    if (auto event = queue.Next(now)) out.push_back(*std::move(event));
  }
  for (const auto& [sender, advice] : newest) {
    RC_ASSERT(std::find(out.begin(), out.end(), advice) != out.end());
  }
  RC_ASSERT(queue.bytes() == 0u);
  RC_ASSERT(queue.num_senders() == 0u);
}

RC_GTEST_PROP(AdviceQueueProperty, SendersTakeTurnsAndTheShortestComesFirst,
              ()) {
  AdviceQueue queue;
  for (const Sent& sent : AnyMessages()) queue.Add(sent.sender, sent.advice);
  const std::size_t senders = queue.num_senders();
  std::map<std::int64_t, std::int64_t> steps_before;
  std::map<std::int64_t, std::size_t> turn_before;
  std::size_t turn = 0;
  while (queue.size() > 0) {
    const auto event = queue.Next(queue.next_us());
    RC_ASSERT(event.has_value());
    const std::int64_t steps = StepsToJudge(event->waypoints);
    const auto known = steps_before.find(event->session);
    if (known != steps_before.end()) {
      RC_ASSERT(known->second <= steps);
      RC_ASSERT(turn - turn_before[event->session] <= senders);
    } else {
      RC_ASSERT(turn < senders);
    }
    steps_before[event->session] = steps;
    turn_before[event->session] = turn++;
  }
}

}  // namespace
}  // namespace terra::verifier

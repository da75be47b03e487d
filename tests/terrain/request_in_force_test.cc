#include "terrain/request_in_force.h"

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random_map.h"

namespace terra {
namespace {

using Change = RequestRule::Change;
using testing::Random;

TEST(ReplacedIdsTest, RemembersSoManyAndForgetsTheOldestFirst) {
  ReplacedIds ids(2);
  ids.Add(1);
  ids.Add(2);
  EXPECT_TRUE(ids.Has(1));
  ids.Add(3);
  EXPECT_FALSE(ids.Has(1));
  EXPECT_TRUE(ids.Has(2));
  EXPECT_TRUE(ids.Has(3));
}

TEST(ReplacedIdsTest, AnIdTakesOnePlaceHoweverOftenItIsReplaced) {
  ReplacedIds ids(2);
  ids.Add(1);
  ids.Add(2);
  ids.Add(2);
  EXPECT_TRUE(ids.Has(1));
}

TEST(ReplacedIdsTest, ZeroIsNoIdAndTakesNoPlace) {
  ReplacedIds ids(2);
  ids.Add(1);
  ids.Add(2);
  ids.Add(0);
  EXPECT_FALSE(ids.Has(0));
  EXPECT_TRUE(ids.Has(1));
}

RequestInForce Go(std::int64_t id) {
  return {id, false, 0, {1, 0}, {9, 0}};
}

RequestInForce Cancel(std::int64_t id) {
  return {id, true, 0, {1, 0}, {9, 0}};
}

TEST(RequestRuleTest, AnAnswerOfSessionZeroMovesNothingOn) {
  RequestRule rule;
  rule.OnRequest(Go(6));
  EXPECT_EQ(rule.OnAnswer(Go(7), 0), Change::kOther) << "it is only late";
  EXPECT_EQ(rule.OnAnswer(Go(6), 0), Change::kSame);
  EXPECT_EQ(rule.OnAnswer(Go(7), 0), Change::kOther) << "0 names nobody";
  EXPECT_EQ(rule.current(), Go(6));
}

TEST(RequestRuleTest, AnAnswerOfSessionZeroIsTakenOverWhereThereIsNoRequest) {
  RequestRule rule;
  EXPECT_EQ(rule.OnAnswer(Go(6), 0), Change::kReplaced);
  EXPECT_EQ(rule.current(), Go(6));
}

TEST(RequestRuleTest, ACancelThatOnlyTheOtherSideHeardHolds) {
  RequestRule rule;
  rule.OnRequest(Go(6));
  EXPECT_EQ(rule.OnAnswer(Cancel(6), 70), Change::kCancelled);
  EXPECT_EQ(rule.OnAnswer(Cancel(6), 70), Change::kSame);
  EXPECT_EQ(rule.OnRequest(Go(6)), Change::kSame);
  EXPECT_TRUE(rule.current().cancelled);
}

TEST(RequestRuleTest, AnAnswerTellsTheWholeRequest) {
  RequestRule rule;
  const RequestInForce carried = {5, true, 0, {1, 2}, {3, 4}};
  EXPECT_EQ(rule.OnAnswer(carried, 70), Change::kReplaced);
  EXPECT_EQ(rule.current(), carried);
}

// What the documents say, in other words and without a bound on what is kept.
class Model {
 public:
  void OnRequest(const RequestInForce& asked) {
    if (asked.request_id == 0 || IsOld(asked.request_id)) return;
    if (asked.request_id != current.request_id) {
      if (asked.cancelled) {
        old.push_back(asked.request_id);
      } else {
        Begin(asked);
      }
    } else if (asked.cancelled) {
      current.cancelled = true;
    }
  }

  void OnAnswer(const RequestInForce& carried, std::int64_t session) {
    if (carried.request_id == 0 || IsOld(carried.request_id)) return;
    if (carried.request_id == current.request_id) {
      if (carried.cancelled) current.cancelled = true;
    } else if (current.request_id == 0 ||
               (session != 0 && last_named_by == session)) {
      Begin(carried);
    } else {
      return;
    }
    last_named_by = session;
  }

  bool IsOld(std::int64_t id) const {
    const auto first =
        old.size() > RequestRule::kRemembered
            ? old.end() - std::ptrdiff_t{RequestRule::kRemembered}
            : old.begin();
    return std::find(first, old.end(), id) != old.end();
  }

  RequestInForce current;
  std::vector<std::int64_t> old;
  std::int64_t last_named_by = 0;

 private:
  void Begin(const RequestInForce& request) {
    if (current.request_id != 0) old.push_back(current.request_id);
    current = request;
    last_named_by = 0;
  }
};

// Few ids and sessions, so that they meet; among them those that an attacker
// would try.
std::int64_t AnyNumber(Random& random, int most) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  switch (random.Int(0, 9)) {
    case 0:
      return 0;
    case 1:
      return random.OneIn(2) ? kLeast : kMost;
    case 2:
      return -1;
    default:
      return random.Int(1, most);
  }
}

TEST(RequestRuleTest, FollowsItsModelThroughRandomEvents) {
  constexpr int kSequences = 5'000;
  for (int sequence = 0; sequence < kSequences; ++sequence) {
    Random random(static_cast<std::uint64_t>(sequence));
    // Some sequences use more ids than are remembered.
    const int most_ids = random.OneIn(4) ? 100 : 5;
    RequestRule rule;
    Model model;
    for (int i = random.Int(1, 300); i > 0; --i) {
      const RequestInForce before = rule.current();
      const RequestInForce message = {
          AnyNumber(random, most_ids), random.OneIn(5), random.Int(0, 1),
          Cell{random.Int(0, 2), 0}, Cell{random.Int(0, 2), 1}};
      Change change = Change::kOther;
      if (random.OneIn(2)) {
        change = rule.OnRequest(message);
        model.OnRequest(message);
      } else {
        const std::int64_t session = AnyNumber(random, 3);
        change = rule.OnAnswer(message, session);
        model.OnAnswer(message, session);
      }
      const RequestInForce& now = rule.current();
      ASSERT_EQ(now, model.current) << "sequence " << sequence;
      // What it says of the message is what became of it.
      ASSERT_EQ(change == Change::kReplaced,
                now.request_id != before.request_id)
          << "sequence " << sequence;
      ASSERT_EQ(change == Change::kCancelled,
                now.request_id == before.request_id && now != before)
          << "sequence " << sequence;
      ASSERT_EQ(change != Change::kOther,
                now.any() && message.request_id == now.request_id)
          << "sequence " << sequence;
      // Nothing but a replacement changes where it leads.
      if (change != Change::kReplaced) {
        ASSERT_EQ(now.goal, before.goal);
        ASSERT_GE(now.cancelled, before.cancelled);
      }
    }
  }
}

}  // namespace
}  // namespace terra

// The journal's messages, its rate, and the order in which it is played.
#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "terrain/digest.h"
#include "tests/verifier/gate_field.h"
#include "verifier/gate_codec.h"
#include "verifier/gate_core.h"
#include "verifier/journal_budget.h"
#include "verifier/journal_codec.h"
#include "verifier/journal_node.h"

namespace terra::verifier {
namespace {

using terra_msg::advice_t;
using terra_msg::gate_step_t;

constexpr std::int64_t kSecond = 1'000'000;

// ---- The core ----

TEST(GateCoreTest, EveryEventThatMattersChangesTheDigest) {
  GateHarness h;
  std::vector<std::int64_t> digests = {CoreDigest(h.gate)};
  const auto note = [&] {
    digests.push_back(CoreDigest(h.gate));
  };
  h.Map(Field());
  note();
  h.Request(1);
  note();
  h.Baseline(kStraight);
  note();
  h.Pose({1, 1});
  note();
  h.Advise(kStraight);  // a verdict, which counts
  note();
  h.gate.On(h.AdviceFrom(1, {1, 1}, {{1, 1}, {2, 0}, {4, 0}, {5, 1}}));
  ASSERT_EQ(h.deployed().mode, Mode::kCandidate);
  note();
  h.Cancel(1);
  note();
  std::ranges::sort(digests);
  EXPECT_EQ(std::ranges::adjacent_find(digests), digests.end());
}

TEST(GateCoreTest, WhatIsSaidAgainChangesNothing) {
  GateHarness h = Ready();
  const AdviceEvent advice = h.AdviceOf(kTop);
  h.gate.On(advice);
  const CoreNames names = NamesOf(h.gate);
  h.Map(Field());
  h.Request(1);
  h.gate.On(advice);
  EXPECT_EQ(h.gate.lookup(), Lookup::kRepeat);
  EXPECT_EQ(NamesOf(h.gate), names);
}

TEST(GateCoreTest, NoGateGoesOnFromWhatNoGateCanBeIn) {
  GateHarness h = Ready();
  GateState state;
  state.request = h.gate.request();
  state.map = std::make_shared<const TerrainMap>(Field());
  state.map_id = h.map_id;
  state.deployed = h.deployed();
  state.place = 0;
  state.decisions = h.gate.decisions();
  EXPECT_TRUE(Gate::GoOnFrom({}, state));
  GateState wrong = state;
  wrong.map = nullptr;
  EXPECT_FALSE(Gate::GoOnFrom({}, wrong)) << "a route without a map";
  wrong = state;
  wrong.deployed.waypoints = {{0, 1}, {9, 9}, {5, 1}};
  EXPECT_FALSE(Gate::GoOnFrom({}, wrong)) << "a route that leaves the map";
  wrong = state;
  wrong.deployed.waypoints.clear();
  EXPECT_FALSE(Gate::GoOnFrom({}, wrong)) << "a route without waypoints";
  for (const int place : {-1, 6, 1'000'000}) {
    wrong = state;
    wrong.place = place;
    EXPECT_FALSE(Gate::GoOnFrom({}, wrong)) << "place " << place;
  }
}

// ---- The codec ----

gate_step_t StepOf(const JournalEvent& event) {
  gate_step_t step = ToStep(event, Lookup::kNew, 7, {}, {}, 9);
  step.event_bytes = event.bytes;
  step.num_bytes = static_cast<std::int32_t>(event.bytes.size());
  return step;
}

TEST(JournalCodecTest, AnEventComesOutAsItWentIn) {
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceOf(kTop);
  advice.anchor = {GateHarness::kSession, 3, 5, {1, 1}};
  advice.heard = {advice.session, 12, -31};
  const JournalEvent event = InJournal(advice);
  const auto read = EventOf(StepOf(event), event.bytes);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(std::get<AdviceEvent>(*read), advice);
}

TEST(JournalCodecTest, AdviceIsWrittenDownWithoutWhatTheGateDoesNotRead) {
  advice_t message{};
  message.session = 900;
  message.advisor = "llm";
  message.kind = advice_t::KIND_PROPOSE;
  bus::SetWaypoints(message, kTop);
  const std::size_t bare = InJournal(ToEvent(message)).bytes.size();
  message.answer_text.assign(16'000, 'x');
  message.model = "any";
  EXPECT_EQ(InJournal(ToEvent(message)).bytes.size(), bare);
}

TEST(JournalCodecTest, BytesOfAnotherMessageAreRefused) {
  GateHarness h = Ready();
  const JournalEvent event = InJournal(h.AdviceOf(kTop));
  gate_step_t step = StepOf(event);
  ++step.event_seq;
  EXPECT_FALSE(EventOf(step, event.bytes).ok());
  step = StepOf(event);
  ++step.event_session;
  EXPECT_FALSE(EventOf(step, event.bytes).ok());
  for (const int kind : {-128, -1, 0, int{gate_step_t::KIND_TICK},
                         int{gate_step_t::KIND_RESTORED}, 8, 127}) {
    step = StepOf(event);
    step.kind = static_cast<std::int8_t>(kind);
    EXPECT_FALSE(EventOf(step, event.bytes).ok()) << kind;
  }
  step = StepOf(event);
  step.kind = gate_step_t::KIND_BASELINE;
  EXPECT_FALSE(EventOf(step, event.bytes).ok()) << "advice is no baseline";
}

// ---- The rate ----

TEST(JournalBudgetTest, NoSecondTakesMoreThanBurstAndRate) {
  constexpr JournalBudget::Limits kLimits{.bytes_per_s = 1'000, .burst = 500};
  JournalBudget budget(kLimits);
  std::int64_t taken = 0;
  // Ten seconds, asked for far too much in uneven pieces.
  for (std::int64_t now = 0; now < 10 * kSecond; now += 997) {
    for (const std::int64_t bytes : {7, 90, 3}) {
      if (budget.Take(bytes, 0, now)) taken += bytes;
    }
  }
  EXPECT_LE(taken, 10 * kLimits.bytes_per_s + kLimits.burst);
  EXPECT_GE(taken, 10 * kLimits.bytes_per_s) << "nothing is lost to rounding";
}

TEST(JournalBudgetTest, WhatIsLeftForOthersIsNotTaken) {
  JournalBudget budget({.bytes_per_s = 1'000, .burst = 500});
  EXPECT_FALSE(budget.Take(401, 100, 0));
  EXPECT_TRUE(budget.Take(400, 100, 0));
  EXPECT_FALSE(budget.Take(1, 100, 0));
  EXPECT_TRUE(budget.Take(100, 0, 0));
}

TEST(JournalBudgetTest, AnyTimesWillDo) {
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  JournalBudget budget({.bytes_per_s = 1'000, .burst = 500});
  EXPECT_TRUE(budget.Take(500, 0, kLeast));
  EXPECT_FALSE(budget.Take(500, 0, kLeast + 1));
  EXPECT_TRUE(budget.Take(500, 0, kMost));
  EXPECT_FALSE(budget.Take(500, 0, 0)) << "a clock that ran back stands";
}

// ---- The writer ----

class JournalWriterTest : public ::testing::Test, public bus::Transport {
 protected:
  bool Publish(bus::Channel channel,
               std::span<const std::uint8_t> bytes) override {
    EXPECT_EQ(channel, bus::Channel::kGateStep);
    EXPECT_LE(bytes.size(), bus::kMaxMessageBytes);
    sent_bytes_ += static_cast<std::int64_t>(bytes.size());
    steps_.push_back(bus::Decode<gate_step_t>(bytes).value());
    return true;
  }

  void Write(std::int8_t kind, std::size_t event_bytes,
             std::int64_t now_us = 0) {
    gate_step_t step{};
    step.kind = kind;
    step.now_us = now_us;
    writer_.Write(step, Bytes(event_bytes, 7));
  }

  std::int64_t sent_bytes_ = 0;
  std::vector<gate_step_t> steps_;
  bus::Outbox out_{*this, 4711};
  JournalWriter writer_{out_};
};

TEST_F(JournalWriterTest, NumbersStepsAndSaysWhatTheirBytesAre) {
  Write(gate_step_t::KIND_ADVICE, 100);
  Write(gate_step_t::KIND_MAP, 0);
  ASSERT_EQ(steps_.size(), 2u);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    EXPECT_EQ(steps_[i].step, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(steps_[i].seq, steps_[i].step);
  }
  EXPECT_EQ(steps_[0].num_bytes, 100);
  EXPECT_EQ(steps_[0].bytes_digest, BytesDigest(steps_[0].event_bytes));
  EXPECT_EQ(writer_.without_bytes(), 0);
}

// Advice in a flood, of the largest size that there is and of the smallest.
TEST_F(JournalWriterTest, KeepsWithinItsRateWhateverIsHeard) {
  constexpr std::int64_t kSeconds = 5;
  for (std::int64_t now = 0; now < kSeconds * kSecond; now += 1'000) {
    for (const std::size_t size : {58'000, 200, 60'000, 0}) {
      Write(gate_step_t::KIND_ADVICE, size, now);
      Write(gate_step_t::KIND_BASELINE, size, now);
    }
  }
  EXPECT_LE(sent_bytes_, (kSeconds + 1) * JournalWriter::kMaxBytesPerSecond);
  EXPECT_GT(writer_.left_out(), 0);
  EXPECT_GT(writer_.without_bytes(), 0);
  EXPECT_EQ(writer_.steps(), std::ssize(steps_) + writer_.left_out());
  // A step that is left out has its number and no seq.
  for (std::size_t i = 1; i < steps_.size(); ++i) {
    EXPECT_EQ(steps_[i].seq, steps_[i - 1].seq + 1);
    EXPECT_GT(steps_[i].step, steps_[i - 1].step);
  }
}

TEST_F(JournalWriterTest, AFloodOfAdviceLeavesNoBaselineOut) {
  for (int i = 0; i < 10'000; ++i) Write(gate_step_t::KIND_ADVICE, 50'000);
  ASSERT_GT(writer_.left_out(), 0);
  steps_.clear();
  Write(gate_step_t::KIND_BASELINE, 20'000);
  ASSERT_EQ(steps_.size(), 1u);
  EXPECT_EQ(steps_[0].num_bytes, 20'000);
}

TEST_F(JournalWriterTest, LargeAdviceLeavesRoomForSmall) {
  for (int i = 0; i < 100; ++i) Write(gate_step_t::KIND_ADVICE, 50'000);
  ASSERT_GT(writer_.without_bytes(), 0);
  steps_.clear();
  Write(gate_step_t::KIND_ADVICE, 300);
  ASSERT_EQ(steps_.size(), 1u);
  EXPECT_EQ(steps_[0].num_bytes, 300);
}

// ---- The player ----

constexpr std::int64_t kGate = 4711;

gate_step_t PoseStep(std::int64_t number) {
  terra_msg::pose_t pose{};
  pose.seq = number;
  const JournalEvent event = InJournal(pose);
  gate_step_t step = StepOf(event);
  step.session = kGate;
  step.step = number;
  return step;
}

bus::MapPtr MapOfField() {
  return std::make_shared<const bus::MapInForce>(bus::MapInForce{Field(), 5});
}

TEST(JournalPlayerTest, PlaysTheStepsOfItsSessionOnceAndInOrder) {
  JournalPlayer player(kGate);
  gate_step_t foreign = PoseStep(1);
  foreign.session = kGate + 1;
  EXPECT_FALSE(player.Take(foreign));
  EXPECT_FALSE(player.plays());
  EXPECT_TRUE(player.Take(PoseStep(1))) << "the first";
  EXPECT_FALSE(player.Take(PoseStep(2)));
  EXPECT_FALSE(player.Take(PoseStep(2)));
  EXPECT_FALSE(player.Take(PoseStep(1)));
  EXPECT_FALSE(player.Take(PoseStep(5)));
  EXPECT_TRUE(player.plays());
  std::vector<std::int64_t> played;
  while (const auto next = player.Next()) {
    played.push_back(next->in_journal.heard.seq);
  }
  EXPECT_EQ(played, (std::vector<std::int64_t>{1, 2, 5}));
  EXPECT_EQ(player.missing(), 2) << "3 and 4";
}

TEST(JournalPlayerTest, WaitsForTheMapOfAStep) {
  JournalPlayer player(kGate);
  const bus::MapPtr map = MapOfField();
  gate_step_t step = StepOf(InJournal(MapEvent{nullptr, map->map_id}));
  step.session = kGate;
  step.step = 1;
  player.Take(step);
  player.Take(PoseStep(2));
  EXPECT_FALSE(player.Next());
  EXPECT_EQ(player.waiting(), 2U);
  player.Take(map);
  const auto next = player.Next();
  ASSERT_TRUE(next);
  EXPECT_EQ(std::get<MapEvent>(next->event).map_id, map->map_id);
  EXPECT_TRUE(player.Next());
}

TEST(JournalPlayerTest, WhatWaitsIsBounded) {
  JournalPlayer player(kGate);
  gate_step_t step = StepOf(InJournal(MapEvent{nullptr, 5}));
  step.session = kGate;
  step.step = 1;
  player.Take(step);
  constexpr auto kMost = static_cast<std::int64_t>(JournalPlayer::kMaxWaiting);
  for (std::int64_t number = 2; number <= kMost + 10; ++number) {
    player.Take(PoseStep(number));
  }
  EXPECT_EQ(player.waiting(), JournalPlayer::kMaxWaiting);
  EXPECT_EQ(player.missing(), 10);
}

}  // namespace
}  // namespace terra::verifier

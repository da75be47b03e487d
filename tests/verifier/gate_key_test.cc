// Which advice is judged at all, and how often.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/verifier/gate_field.h"
#include "verifier/gate.h"

namespace terra::verifier {
namespace {

using ::testing::IsEmpty;
using testing::MapFromAscii;

TEST(GateTest, AdviceForAReplacedRequestIsStale) {
  GateHarness h = Ready();
  const AdviceEvent old = h.AdviceOf(kTop);
  h.Request(2);
  h.Baseline(kStraight);
  const Deployed before = h.deployed();
  EXPECT_EQ(CodeOf(h.gate.On(old)), Code::kStaleRequest);
  EXPECT_EQ(h.deployed(), before);
}

TEST(GateTest, AdviceForAReplacedMapIsStale) {
  GateHarness h = Ready();
  const AdviceEvent old = h.AdviceOf(kTop);
  h.Map(MapFromAscii({"111111", "199991", "111112"}));
  const Deployed before = h.deployed();
  EXPECT_EQ(CodeOf(h.gate.On(old)), Code::kStaleMap);
  EXPECT_EQ(h.deployed(), before);
}

TEST(GateTest, AdviceForAReplacedBaselineIsStale) {
  GateHarness h = Ready();
  const AdviceEvent old = h.AdviceOf(kTop);
  h.Baseline(kCorners);
  const Deployed before = h.deployed();
  EXPECT_EQ(CodeOf(h.gate.On(old)), Code::kStaleBaseline);
  EXPECT_EQ(h.deployed(), before);
}

TEST(GateTest, AdviceForWhatTheGateNeverHeldWaits) {
  GateHarness h = Ready();
  const AdviceEvent good = h.AdviceOf(kTop);
  AdviceEvent other = good;
  other.request_id = 77;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  other = good;
  other.map_id = 77;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  other = good;
  other.baseline_digest = 77;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  EXPECT_EQ(h.gate.counters().unknown_key, 3);
  EXPECT_EQ(CodeOf(h.gate.On(good)), Code::kAccepted);
}

// 0 is no id: it was never in force, so nothing can have replaced it.
TEST(GateTest, AdviceForNothingWaits) {
  GateHarness h;
  h.Map(Field());
  const AdviceEvent unasked = h.AdviceOf(kTop);
  h.Map(MapFromAscii({"111111", "199991", "111112"}));
  EXPECT_THAT(h.gate.On(unasked), IsEmpty()) << "no request yet";
  h.Request(1);
  h.Baseline(kStraight);
  const AdviceEvent good = h.AdviceOf(kTop);
  AdviceEvent other = good;
  other.request_id = 0;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  other = good;
  other.map_id = 0;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
  other = good;
  other.baseline_digest = 0;
  EXPECT_THAT(h.gate.On(other), IsEmpty());
}

TEST(GateTest, AdviceThatOvertookItsBaselineIsJudgedWhenRepeated) {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.baseline_digest = h.BaselineOf(kStraight).baseline_digest;
  const AdviceEvent early = h.AdviceOf(kTop);
  EXPECT_THAT(h.gate.On(early), IsEmpty());
  h.Baseline(kStraight);
  EXPECT_EQ(CodeOf(h.gate.On(early)), Code::kAccepted);
}

TEST(GateTest, AdviceBeforeAnythingIsHarmless) {
  GateHarness h;
  EXPECT_THAT(h.Advise(kTop), IsEmpty());
  EXPECT_EQ(h.gate.counters().unknown_key, 1);
  EXPECT_EQ(h.deployed(), Deployed{});
}

TEST(GateTest, JudgedAdviceGetsExactlyOneVerdict) {
  GateHarness h = Ready();
  AdviceEvent advice = h.AdviceOf(kTop);
  EXPECT_EQ(h.gate.On(advice).size(), 2u);
  EXPECT_THAT(h.gate.On(advice), IsEmpty());
  EXPECT_EQ(h.gate.counters().repeats, 1);
  advice.waypoints = kBottom;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest)
      << "other content is another advice";
  advice.candidate = 2;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest);
  advice.attempt += 1;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest);
  advice.session += 1;
  EXPECT_EQ(CodeOf(h.gate.On(advice)), Code::kNotBest);
}

TEST(GateTest, ACopiedAttemptNumberSilencesNobody) {
  GateHarness h = Ready();
  const AdviceEvent honest = h.AdviceOf(kTop);
  AdviceEvent copied = honest;
  copied.kind = AdviceKind::kRetain;
  copied.waypoints.clear();
  EXPECT_EQ(CodeOf(h.gate.On(copied)), Code::kRetained);
  EXPECT_TRUE(h.gate.WouldJudge(honest));
  EXPECT_EQ(CodeOf(h.gate.On(honest)), Code::kAccepted);
  EXPECT_FALSE(h.gate.WouldJudge(honest)) << "has its verdict";
}

TEST(GateTest, AdviceThatHasNoVerdictIsNotJudged) {
  GateHarness h = Ready();
  AdviceEvent failed = h.AdviceOf(kTop);
  failed.kind = AdviceKind::kFailed;
  EXPECT_FALSE(h.gate.WouldJudge(failed));
  AdviceEvent unknown = h.AdviceOf(kTop);
  unknown.request_id += 1;
  EXPECT_FALSE(h.gate.WouldJudge(unknown));
}

TEST(GateTest, AFloodDoesNotMakeRepeatedAdviceNew) {
  GateHarness h = Ready();
  const AdviceEvent steady = h.AdviceOf(kTop);
  EXPECT_EQ(CodeOf(h.gate.On(steady)), Code::kAccepted);
  for (int i = 0; i < 20'000; ++i) {
    h.Advise({{0, 1}});
    if (i % 1'000 == 0) {
      ASSERT_THAT(h.gate.On(steady), IsEmpty());
    }
  }
  EXPECT_EQ(h.gate.counters().judged, 20'001);
  EXPECT_EQ(h.gate.counters().accepted, 1);
}

}  // namespace
}  // namespace terra::verifier

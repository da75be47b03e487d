// The gate's shell: what it takes off the bus, what it says and how often. The
// decisions are Gate's and tested there.
#include "verifier/verifier_node.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/codec.h"
#include "bus/request_tracker.h"
#include "terrain/digest.h"
#include "terrain/segment.h"
#include "tests/support/map_messages.h"
#include "tests/support/random_map.h"
#include "tests/verifier/gate_field.h"
#include "verifier/gate_codec.h"

namespace terra::verifier {
namespace {

using std::chrono::milliseconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::gate_step_t;
using terra_msg::plan_request_t;
using terra_msg::pose_t;
using terra_msg::verdict_t;

constexpr Cell kStart = {0, 1};
constexpr Cell kGoal = {5, 1};
constexpr std::int64_t kSession = 4711;

// A node, what it says, and the others' messages about the request from kStart
// to kGoal on Field().
class VerifierNodeTest : public ::testing::Test, public bus::Transport {
 protected:
  bool Publish(bus::Channel channel,
               std::span<const std::uint8_t> bytes) override {
    if (bytes.size() > bus::kMaxMessageBytes) return false;
    if (channel == bus::Channel::kVerdict) {
      verdicts_.push_back(bus::Decode<verdict_t>(bytes).value());
    } else if (channel == bus::Channel::kDeployed) {
      deployed_.push_back(bus::Decode<deployed_t>(bytes).value());
    } else if (channel == bus::Channel::kGateStep) {
      steps_.push_back(bus::Decode<gate_step_t>(bytes).value());
    }
    return true;
  }

  template <typename T>
  void Hear(const T& message) {
    node_.Receive({bus::MessageTraits<T>::kChannel, bus::Encode(message)},
                  now_);
  }
  void HearMap() {
    terra_msg::map_header_t header = bus::MakeMapHeader(Field());
    header.session = 4;
    header.seq = 1;
    Hear(header);
    Hear(testing::AllTiles(Field()));
  }

  static plan_request_t RequestOf(std::int64_t id, std::int8_t action) {
    plan_request_t request{};
    request.request_id = id;
    request.action = action;
    request.start_x = kStart.x;
    request.start_y = kStart.y;
    request.goal_x = kGoal.x;
    request.goal_y = kGoal.y;
    return request;
  }

  baseline_t BaselineOf(std::int64_t request, const Route& route) {
    baseline_t baseline{};
    baseline.session = 500;
    baseline.seq = ++baseline_seq_;
    baseline.planner = "planner";
    baseline.request_id = request;
    baseline.start_x = kStart.x;
    baseline.start_y = kStart.y;
    baseline.goal_x = kGoal.x;
    baseline.goal_y = kGoal.y;
    baseline.map_id = map_id_;
    baseline.status = baseline_t::STATUS_OK;
    bus::SetWaypoints(baseline, route);
    baseline.baseline_digest = BaselineDigest(request, map_id_, route);
    return baseline;
  }

  advice_t AdviceOf(const Route& route) {
    advice_t advice{};
    advice.session = 900;
    advice.advisor = "search";
    advice.attempt = ++attempt_;
    advice.candidate = 1;
    advice.request_id = 1;
    advice.map_id = map_id_;
    advice.baseline_digest = BaselineDigest(1, map_id_, kStraight);
    advice.anchor_x = kStart.x;
    advice.anchor_y = kStart.y;
    advice.kind = advice_t::KIND_PROPOSE;
    bus::SetWaypoints(advice, route);
    return advice;
  }
  // As LCM itself encodes it, with no look at the limits.
  void Send(SenderId sender, const advice_t& advice) {
    std::vector<std::uint8_t> bytes(
        static_cast<std::size_t>(advice.getEncodedSize()));
    advice.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    node_.OnAdviceBytes(sender, bytes, now_);
  }
  void Advise(const advice_t& advice) {
    now_ += milliseconds(5);  // the budget is 200 a second
    Send(1, advice);
    node_.Advance(now_);
  }
  Code CodeFor(const advice_t& advice) {
    verdicts_.clear();
    Advise(advice);
    return verdicts_.size() == 1 ? static_cast<Code>(verdicts_[0].code)
                                 : Code::kNotChecked;
  }

  // The straight baseline of request 1 is deployed.
  void GetReady() {
    HearMap();
    Hear(BaselineOf(1, kStraight));
    ASSERT_EQ(deployed_.back().mode, deployed_t::MODE_BASELINE);
  }

  std::int64_t Counter(const std::string& name) const {
    bus::Counters counters;
    node_.AddCounters(counters);
    for (const auto& [counter, value] : counters) {
      if (counter == name) return value;
    }
    ADD_FAILURE() << "no counter " << name;
    return -1;
  }

  bus::Time now_{std::chrono::hours(1)};
  std::int64_t map_id_ = MapId(Field());
  std::int64_t baseline_seq_ = 0;
  std::int64_t attempt_ = 0;
  std::vector<verdict_t> verdicts_;
  std::vector<deployed_t> deployed_;
  std::vector<gate_step_t> steps_;
  bus::Outbox out_{*this, kSession};
  VerifierNode node_{{}, out_};
};

TEST_F(VerifierNodeTest, SaysWhatIsDeployedAtOnceAndThenFiveTimesASecond) {
  HearMap();
  Hear(RequestOf(1, plan_request_t::ACTION_GO));
  Hear(BaselineOf(1, kStraight));
  ASSERT_EQ(deployed_.size(), 2u);
  EXPECT_EQ(deployed_[0].mode, deployed_t::MODE_NONE);
  EXPECT_EQ(deployed_[1].mode, deployed_t::MODE_BASELINE);
  EXPECT_EQ(node_.Advance(now_), now_ + milliseconds(200));
  EXPECT_EQ(deployed_.size(), 2u) << "just said";
  for (int i = 0; i < 5; ++i) {
    now_ += milliseconds(200);
    node_.Advance(now_);
  }
  ASSERT_EQ(deployed_.size(), 7u);
  EXPECT_EQ(deployed_.back().route_seq, deployed_[1].route_seq);
  EXPECT_EQ(deployed_.back().seq, 7);
}

TEST_F(VerifierNodeTest, SaysNothingBeforeThereIsARequest) {
  HearMap();
  EXPECT_EQ(node_.Advance(now_), bus::kNever);
  now_ += milliseconds(500);
  node_.Advance(now_);
  EXPECT_TRUE(deployed_.empty());
}

TEST_F(VerifierNodeTest, ARouteIsSaidByWaypointsAndByCells) {
  GetReady();
  Advise(AdviceOf(kTop));
  const deployed_t& said = deployed_.back();
  EXPECT_EQ(bus::WaypointsOf(said), kTop);
  const auto cells = bus::DecodeChain(kStart, {said.num_steps, said.chain});
  ASSERT_TRUE(cells.ok());
  EXPECT_EQ(*cells, RasterizeRoute(kTop));
  EXPECT_EQ(said.source, "search");
  EXPECT_EQ(said.baseline_cost, 37);
}

TEST_F(VerifierNodeTest, WhatCostsNothingKnownIsNotANumber) {
  HearMap();
  Hear(RequestOf(1, plan_request_t::ACTION_GO));
  EXPECT_TRUE(std::isnan(deployed_.back().deployed_cost));
  EXPECT_TRUE(std::isnan(deployed_.back().baseline_cost));
}

TEST_F(VerifierNodeTest, ARequestWithoutAKnownActionIsNone) {
  HearMap();
  for (const int action : {-1, 0, 3, 127}) {
    Hear(RequestOf(1, static_cast<std::int8_t>(action)));
  }
  EXPECT_TRUE(deployed_.empty());
  EXPECT_EQ(Counter("malformed"), 4);
  EXPECT_EQ(node_.last_error(),
            "TERRA_PLAN_REQUEST: action 127 is neither go (1) nor cancel (2)");
  Hear(RequestOf(0, plan_request_t::ACTION_GO));
  EXPECT_EQ(node_.last_error(),
            "TERRA_PLAN_REQUEST: request_id 0 names no request");
}

TEST_F(VerifierNodeTest, CancelWithdrawsTheRoute) {
  GetReady();
  Hear(RequestOf(1, plan_request_t::ACTION_CANCEL));
  EXPECT_EQ(deployed_.back().cause, deployed_t::CAUSE_CANCELLED);
}

TEST_F(VerifierNodeTest, APlannerThatWasReplacedIsIgnored) {
  GetReady();
  baseline_t other = BaselineOf(1, kCorners);
  other.session = 501;
  Hear(other);
  EXPECT_EQ(bus::WaypointsOf(deployed_.back()), kCorners);
  const std::size_t said = deployed_.size();
  Hear(BaselineOf(1, kTop));
  EXPECT_EQ(deployed_.size(), said);
  EXPECT_EQ(Counter("from_replaced_planner"), 1);
}

TEST_F(VerifierNodeTest, AnOldBaselineOfTheSamePlannerIsIgnored) {
  HearMap();
  const baseline_t old = BaselineOf(1, kTop);
  Hear(BaselineOf(1, kStraight));
  Hear(old);
  EXPECT_EQ(bus::WaypointsOf(deployed_.back()), kStraight);
}

TEST_F(VerifierNodeTest, OnlyStatusOkHasARoute) {
  HearMap();
  for (const int status :
       {int{baseline_t::STATUS_NONE}, int{baseline_t::STATUS_NO_ROUTE},
        int{baseline_t::STATUS_TOO_LONG}, -1, 127}) {
    baseline_t baseline = BaselineOf(1, kStraight);
    baseline.status = static_cast<std::int8_t>(status);
    Hear(baseline);
    EXPECT_EQ(deployed_.back().mode, deployed_t::MODE_NONE) << status;
  }
  baseline_t cancelled = BaselineOf(1, kStraight);
  cancelled.status = baseline_t::STATUS_CANCELLED;
  Hear(cancelled);
  EXPECT_EQ(deployed_.back().cause, deployed_t::CAUSE_CANCELLED);
}

TEST_F(VerifierNodeTest, AnyByteMayBeTheKindOfAdvice) {
  GetReady();
  for (int kind = -128; kind <= 127; ++kind) {
    advice_t advice = AdviceOf({});
    advice.kind = static_cast<std::int8_t>(kind);
    const Code code = CodeFor(advice);
    switch (kind) {
      case advice_t::KIND_RETAIN:
        EXPECT_EQ(code, Code::kRetained);
        break;
      case advice_t::KIND_PROPOSE:
        EXPECT_EQ(code, Code::kTooFewWaypoints);
        break;
      case advice_t::KIND_MALFORMED:
        EXPECT_EQ(code, Code::kParseError);
        break;
      case advice_t::KIND_FAILED:
        EXPECT_EQ(code, Code::kNotChecked) << "no verdict";
        break;
      default:
        EXPECT_EQ(code, Code::kMalformedMessage) << kind;
    }
  }
}

TEST_F(VerifierNodeTest, AnchorAndPoseAreTheMessages) {
  GetReady();
  pose_t pose{};
  pose.pose_x = 1;
  pose.pose_y = 1;
  pose.deployed_session = kSession;
  pose.deployed_route_seq = deployed_.back().route_seq;
  Hear(pose);
  EXPECT_EQ(CodeFor(AdviceOf(kTop)), Code::kLate);
  advice_t ahead = AdviceOf({{1, 1}, {2, 0}, {4, 0}, {5, 1}});
  ahead.anchor_session = kSession;
  ahead.anchor_route_seq = deployed_.back().route_seq;
  ahead.anchor_index = 1;
  ahead.anchor_x = 1;
  ahead.anchor_y = 1;
  EXPECT_EQ(CodeFor(ahead), Code::kAccepted);
  EXPECT_EQ(verdicts_[0].anchor_index, 1);
  EXPECT_EQ(verdicts_[0].anchor_x, 1);
  EXPECT_EQ(verdicts_[0].cost_to_beat, 28);
}

// As many waypoints as one wants, first at the start and last at the goal.
template <typename Message>
void StretchTo(std::size_t num_waypoints, Message& message) {
  message.waypoint_x.insert(message.waypoint_x.begin(),
                            num_waypoints - message.waypoint_x.size(),
                            message.waypoint_x.front());
  message.waypoint_y.insert(message.waypoint_y.begin(),
                            num_waypoints - message.waypoint_y.size(),
                            message.waypoint_y.front());
  message.num_waypoints = static_cast<std::int32_t>(num_waypoints);
}

// Whatever fits a message has its verdict, so that its author learns of it.
TEST_F(VerifierNodeTest, AdviceOfTooManyWaypointsIsToldSo) {
  GetReady();
  for (const std::size_t num_waypoints : {2'049U, 3'000U, 7'400U}) {
    advice_t advice = AdviceOf(kTop);
    StretchTo(num_waypoints, advice);
    ASSERT_LE(bus::Encode(advice).size(), bus::kMaxMessageBytes);
    EXPECT_EQ(CodeFor(advice), Code::kWorkLimit) << num_waypoints;
    EXPECT_EQ(verdicts_.at(0).attempt, attempt_);
  }
  EXPECT_EQ(Counter("malformed_advice"), 0);
  advice_t advice = AdviceOf(kTop);
  StretchTo(2'048, advice);
  EXPECT_EQ(CodeFor(advice), Code::kAccepted);
}

TEST_F(VerifierNodeTest, ABaselineOfTooManyWaypointsIsToldSo) {
  HearMap();
  Hear(RequestOf(1, plan_request_t::ACTION_GO));
  baseline_t baseline = BaselineOf(1, kStraight);
  StretchTo(2'049, baseline);
  baseline.baseline_digest =
      BaselineDigest(1, map_id_, bus::WaypointsOf(baseline));
  Hear(baseline);
  ASSERT_EQ(verdicts_.size(), 1u);
  EXPECT_EQ(verdicts_[0].subject, verdict_t::SUBJECT_BASELINE);
  EXPECT_EQ(verdicts_[0].code, verdict_t::CODE_WORK_LIMIT);
  EXPECT_EQ(deployed_.back().mode, deployed_t::MODE_HOLD);
  EXPECT_EQ(Counter("malformed"), 0);
}

TEST_F(VerifierNodeTest, ABaselineOfAPlannerWithTooLongANameIsToldSo) {
  HearMap();
  Hear(RequestOf(1, plan_request_t::ACTION_GO));
  baseline_t baseline = BaselineOf(1, kStraight);
  baseline.planner.assign(bus::kMaxNameBytes + 1, 'x');
  Hear(baseline);
  ASSERT_EQ(verdicts_.size(), 1u);
  EXPECT_EQ(verdicts_[0].subject, verdict_t::SUBJECT_BASELINE);
  EXPECT_EQ(verdicts_[0].code, verdict_t::CODE_MALFORMED_MESSAGE);
  EXPECT_EQ(verdicts_[0].advisor, std::string(bus::kMaxNameBytes, 'x'));
  EXPECT_EQ(deployed_.back().mode, deployed_t::MODE_HOLD);
  baseline = BaselineOf(1, kStraight);
  baseline.planner.assign(bus::kMaxNameBytes, 'x');
  Hear(baseline);
  EXPECT_EQ(deployed_.back().mode, deployed_t::MODE_HOLD)
      << "its digest is that of the one refused";
}

TEST_F(VerifierNodeTest, SaysWhatIsWrongWithAMessageThatDoesNotDecode) {
  GetReady();
  std::vector<std::uint8_t> bytes = bus::Encode(BaselineOf(1, kTop));
  bytes.pop_back();
  node_.Receive({bus::Channel::kBaseline, bytes}, now_);
  EXPECT_EQ(Counter("malformed"), 1);
  EXPECT_NE(node_.last_error().find("TERRA_BASELINE: malformed message"),
            std::string::npos)
      << node_.last_error();
}

// What the gate says repeats the names of others. If they had no bound, advice
// that is accepted could keep DEPLOYED from ever fitting a message again.
TEST_F(VerifierNodeTest, NoNameKeepsTheGateFromSpeaking) {
  GetReady();
  advice_t advice = AdviceOf(kTop);
  for (const std::size_t length : {std::size_t{59'700}, kMaxNameBytes + 1}) {
    advice = AdviceOf(kTop);
    advice.advisor.assign(length, 'x');
    EXPECT_EQ(CodeFor(advice), Code::kMalformedMessage);
    EXPECT_EQ(verdicts_.at(0).advisor, std::string(kMaxNameBytes, 'x'));
  }
  EXPECT_EQ(Counter("accepted"), 0);
  const std::size_t said = deployed_.size();
  now_ += milliseconds(200);
  node_.Advance(now_);
  EXPECT_EQ(deployed_.size(), said + 1);
  advice = AdviceOf(kTop);
  advice.advisor.assign(kMaxNameBytes, 'x');
  EXPECT_EQ(CodeFor(advice), Code::kAccepted);
  EXPECT_EQ(deployed_.back().source.size(), bus::kMaxNameBytes);
}

TEST_F(VerifierNodeTest, MalformedAdviceIsCountedAndHidesNoTroubleWithTheMap) {
  const std::vector<std::uint8_t> garbage(40, 7);
  node_.OnAdviceBytes(1, garbage, now_);
  EXPECT_EQ(Counter("malformed_advice"), 1);
  EXPECT_NE(node_.last_error().find("advice"), std::string::npos);
  terra_msg::map_header_t header = bus::MakeMapHeader(Field());
  header.session = 4;
  header.seq = 1;
  header.width = -1;
  Hear(header);
  node_.OnAdviceBytes(1, garbage, now_);
  EXPECT_EQ(node_.last_error().find("advice"), std::string::npos);
  EXPECT_FALSE(node_.last_error().empty());
}

// The loop looks at the deployed bus between two calls of Advance.
TEST_F(VerifierNodeTest, OneAdviceIsJudgedInATurnAndSendersTakeTurns) {
  GetReady();
  node_.Advance(now_);
  Send(1, AdviceOf(kTop));
  Send(1, AdviceOf(kTop));
  advice_t other = AdviceOf(kTop);
  other.session = 901;
  Send(2, other);
  EXPECT_TRUE(verdicts_.empty());
  EXPECT_EQ(Counter("advice_waiting"), 3);
  std::vector<std::int64_t> sessions;
  for (std::size_t turn = 1; turn <= 3; ++turn) {
    const bus::Time next = node_.Advance(now_);
    ASSERT_EQ(verdicts_.size(), turn);
    EXPECT_EQ(next <= now_, turn < 3) << "at once, while there is more";
    sessions.push_back(verdicts_.back().advisor_session);
  }
  EXPECT_EQ(sessions, (std::vector<std::int64_t>{900, 901, 900}));
}

TEST_F(VerifierNodeTest, ARepeatTakesNobodysTurn) {
  GetReady();
  const advice_t advice = AdviceOf(kTop);
  Advise(advice);
  Send(1, advice);
  EXPECT_EQ(Counter("repeats"), 1);
  EXPECT_EQ(Counter("advice_waiting"), 0);
}

TEST_F(VerifierNodeTest, AReplayJudgesAdviceInOrderOfArrival) {
  VerifierNode replay{{.session = kSession}, out_};
  replay.ListenToAdvice();
  const auto hear = [&](const auto& message) {
    using T = std::decay_t<decltype(message)>;
    replay.Receive({bus::MessageTraits<T>::kChannel, bus::Encode(message)},
                   now_);
  };
  terra_msg::map_header_t header = bus::MakeMapHeader(Field());
  header.session = 4;
  header.seq = 1;
  hear(header);
  hear(testing::AllTiles(Field()));
  hear(BaselineOf(1, kStraight));
  hear(AdviceOf(kTop));
  EXPECT_EQ(verdicts_.size(), 1u) << "before any turn";
}

// ---- The journal ----

TEST_F(VerifierNodeTest, WritesAStepOfEachEventThatMatters) {
  HearMap();
  Hear(RequestOf(1, plan_request_t::ACTION_GO));
  Hear(RequestOf(1, plan_request_t::ACTION_GO));
  Hear(BaselineOf(1, kStraight));
  Hear(BaselineOf(1, kStraight));  // a repetition, with a new number
  const advice_t advice = AdviceOf(kTop);
  Advise(advice);
  Advise(advice);
  pose_t pose{};
  pose.deployed_session = kSession;
  pose.deployed_route_seq = 1;  // of another route
  Hear(pose);
  std::vector<int> kinds;
  std::vector<int> decisions;
  for (const gate_step_t& step : steps_) {
    EXPECT_EQ(step.step, std::ssize(kinds) + 1);
    EXPECT_EQ(step.session, kSession);
    kinds.push_back(step.kind);
    decisions.push_back(step.num_decisions);
  }
  EXPECT_EQ(kinds, (std::vector<int>{
                       gate_step_t::KIND_MAP, gate_step_t::KIND_REQUEST,
                       gate_step_t::KIND_BASELINE, gate_step_t::KIND_ADVICE}));
  EXPECT_EQ(decisions, (std::vector<int>{0, 1, 1, 2}));
  EXPECT_EQ(Counter("journal_steps"), 4);
  // A pose that moves the robot decides nothing and counts.
  pose.pose_x = 1;
  pose.deployed_route_seq = deployed_.back().route_seq;
  Hear(pose);
  ASSERT_EQ(steps_.size(), 5u);
  EXPECT_EQ(steps_[4].kind, gate_step_t::KIND_POSE);
  EXPECT_NE(steps_[4].core_before, steps_[4].core_after);
}

TEST_F(VerifierNodeTest, AStepSaysWhatItsEventWas) {
  GetReady();
  const deployed_t in_force = deployed_.back();
  const advice_t advice = AdviceOf(kTop);
  now_ += milliseconds(5);
  Send(1, advice);
  node_.Advance(now_);
  const gate_step_t& step = steps_.back();
  EXPECT_EQ(step.now_us, std::chrono::duration_cast<std::chrono::microseconds>(
                             now_.time_since_epoch())
                             .count());
  EXPECT_EQ(step.lookup, gate_step_t::LOOKUP_NEW);
  EXPECT_EQ(step.event_session, advice.session);
  EXPECT_EQ(step.event_seq, advice.seq);
  EXPECT_EQ(step.event_digest, BytesDigest(bus::Encode(advice)));
  EXPECT_EQ(step.decision, in_force.decision);
  EXPECT_EQ(step.map_id, map_id_);
  EXPECT_EQ(step.request_id, 1);
  EXPECT_EQ(step.route_seq, in_force.route_seq);
  const auto heard = bus::Decode<advice_t>(step.event_bytes);
  ASSERT_TRUE(heard.ok());
  EXPECT_EQ(bus::WaypointsOf(*heard), kTop);
}

// It changes the gate's memory and nothing else.
TEST_F(VerifierNodeTest, ACancelOfARequestThatDidNotComeIsAStep) {
  GetReady();
  const std::size_t before = steps_.size();
  Hear(RequestOf(7, plan_request_t::ACTION_CANCEL));
  ASSERT_EQ(steps_.size(), before + 1);
  EXPECT_EQ(steps_.back().core_before, steps_.back().core_after);
  Hear(RequestOf(7, plan_request_t::ACTION_CANCEL));
  EXPECT_EQ(steps_.size(), before + 1);
}

TEST_F(VerifierNodeTest, TheJournalGoesToABusOfItsOwn) {
  struct Other : bus::Transport {
    bool Publish(bus::Channel channel, std::span<const std::uint8_t>) override {
      EXPECT_EQ(channel, bus::Channel::kGateStep);
      ++steps;
      return true;
    }
    int steps = 0;
  } other;
  bus::Outbox journal{other, kSession};
  node_.WriteJournalTo(journal);
  GetReady();
  EXPECT_EQ(other.steps, 2);
  EXPECT_TRUE(steps_.empty());
}

// With the first step of the session the gate begins anew, and from then on
// hears nothing else.
TEST_F(VerifierNodeTest, PlaysAJournalAndNothingElse) {
  GetReady();
  Advise(AdviceOf(kTop));
  const std::vector<gate_step_t> journal = std::exchange(steps_, {});
  const std::vector<deployed_t> said = std::exchange(deployed_, {});
  verdicts_.clear();
  bus::Outbox out{*this, kSession + 1};
  VerifierNode replay{{.session = kSession}, out};
  const auto hear = [&](const auto& message) {
    using T = std::decay_t<decltype(message)>;
    replay.Receive({bus::MessageTraits<T>::kChannel, bus::Encode(message)},
                   now_);
  };
  terra_msg::map_header_t header = bus::MakeMapHeader(Field());
  header.session = 4;
  header.seq = 1;
  hear(header);
  hear(testing::AllTiles(Field()));
  hear(BaselineOf(1, kBottom));  // as an input, before the journal
  deployed_.clear();
  for (const gate_step_t& step : journal) hear(step);
  hear(RequestOf(2, plan_request_t::ACTION_GO));
  ASSERT_EQ(deployed_.size(), said.size());
  for (std::size_t i = 0; i < said.size(); ++i) {
    EXPECT_EQ(deployed_[i].decision, said[i].decision);
    EXPECT_EQ(deployed_[i].route_seq, said[i].route_seq);
    EXPECT_EQ(bus::WaypointsOf(deployed_[i]), bus::WaypointsOf(said[i]));
  }
  ASSERT_EQ(verdicts_.size(), 1u);
  EXPECT_EQ(verdicts_[0].code, verdict_t::CODE_ACCEPTED);
  bus::Counters counters;
  replay.AddCounters(counters);
  for (const char* name :
       {"replay_waiting", "replay_missing", "replay_differs"}) {
    EXPECT_EQ(std::ranges::count(counters,
                                 std::pair(std::string(name), std::int64_t{0})),
              1)
        << name;
  }
}

TEST_F(VerifierNodeTest, TakesAdviceOffTheDeployedBusOnlyWhenTold) {
  GetReady();
  Hear(AdviceOf(kTop));
  EXPECT_TRUE(verdicts_.empty());
  node_.ListenToAdvice();
  Hear(AdviceOf(kTop));
  node_.Advance(now_);
  ASSERT_EQ(verdicts_.size(), 1u);
  EXPECT_EQ(verdicts_[0].code, verdict_t::CODE_ACCEPTED);
}

TEST_F(VerifierNodeTest, StateSaysWhatIsInForce) {
  EXPECT_EQ(node_.state(), "waiting for map");
  HearMap();
  EXPECT_EQ(node_.state(), "ready, nothing deployed");
  Hear(BaselineOf(1, {{0, 1}, {9, 9}, {5, 1}}));
  EXPECT_EQ(node_.state(), "on hold: no valid route");
  Hear(BaselineOf(1, kStraight));
  EXPECT_EQ(node_.state(), "ready, baseline deployed");
  Advise(AdviceOf(kTop));
  EXPECT_EQ(node_.state(), "ready, candidate deployed");
}

// ---- The request in force, for the gate and for a planner. ----

std::int64_t AnyOf(testing::Random& random,
                   std::initializer_list<std::int64_t> numbers) {
  return *(numbers.begin() +
           random.Int(0, static_cast<int>(numbers.size()) - 1));
}

// An answer is a BASELINE to the one and a DEPLOYED to the other.
TEST(RequestInForceTest, GateAndPlannerHoldTheSameAfterTheSameMessages) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
    testing::Random random(seed);
    Gate gate;
    bus::RequestTracker planner;
    for (int i = 0; i < 60; ++i) {
      const std::int64_t id = AnyOf(random, {0, 1, 2, 3, 4, -1, kMost});
      const Cell start = {random.Int(0, 2), 0};
      if (random.OneIn(2)) {
        plan_request_t message{};
        message.request_id = id;
        message.action = static_cast<std::int8_t>(
            AnyOf(random, {plan_request_t::ACTION_GO, plan_request_t::ACTION_GO,
                           plan_request_t::ACTION_CANCEL, 0, 3}));
        message.start_x = start.x;
        planner.OnRequest(message);
        if (bus::RequestOf(message)) gate.On(ToEvent(message));
      } else {
        baseline_t message{};
        message.request_id = id;
        message.session = AnyOf(random, {0, 0, 70, 71, -1});
        message.status = random.OneIn(5) ? baseline_t::STATUS_CANCELLED
                                         : baseline_t::STATUS_NO_ROUTE;
        message.start_x = start.x;
        const BaselineEvent event = ToEvent(message);
        gate.On(event);
        planner.OnAnswer({id, event.cancelled, 0, event.start, event.goal},
                         event.session);
      }
      ASSERT_EQ(gate.deployed().request_id, planner.current().request_id)
          << "sequence " << seed;
      ASSERT_EQ(gate.deployed().start, planner.current().start)
          << "sequence " << seed;
      ASSERT_EQ(gate.deployed().cause == Cause::kCancelled,
                planner.current().cancelled)
          << "sequence " << seed;
    }
  }
}

}  // namespace
}  // namespace terra::verifier

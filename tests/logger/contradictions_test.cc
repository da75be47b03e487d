// Whatever a gate is told, and by however many who contradict each other and
// themselves: its journal plays to the same decisions, step by step, and no
// change of the journal goes unnoticed.
#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "terrain/digest.h"
#include "tests/logger/recorded_run.h"
#include "verifier/verifier_node.h"

namespace terra::logger {
namespace {

using std::chrono::milliseconds;
using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::gate_step_t;
using terra_msg::plan_request_t;
using terra_msg::pose_t;
using terra_msg::verdict_t;
using testing::Random;

// ---- A run in which nobody can be believed ----

class Liars {
 public:
  explicit Liars(std::uint64_t seed)
      : random_(seed), margin_(random_.OneIn(4) ? 1.0 : 0.0), run_(margin_) {}

  Messages Play() {
    Ask(101, false);
    run_.Run(milliseconds(300));
    for (int turn = 0; turn < 30; ++turn) {
      SaySomething();
      run_.Run(milliseconds(random_.OneIn(3) ? random_.Int(1, 900) : 10));
    }
    run_.Run(milliseconds(2'000));
    return run_.messages();
  }
  double margin() const { return margin_; }

 private:
  template <typename T>
  const T& AnyOf(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(
        random_.Int(0, static_cast<int>(all.size()) - 1))];
  }

  void SaySomething() {
    switch (random_.Int(0, 13)) {
      case 0:
        return Ask(random_.Int(100, 105), random_.OneIn(4));
      case 1:
        return run_.SaveMap(RecordedRun::BarMap(random_.Int(7, 11),
                                                random_.OneIn(2) ? 60 : -1));
      case 2:
        return random_.OneIn(3) ? run_.StartGate() : run_.StartPlanner();
      case 3:
        return SayBaseline();
      case 4:
      case 5:
        return SayPose();
      case 6:
      case 7:
        return SayAgain();
      default:
        for (int more = random_.Int(1, 8); more > 0; --more) SayAdvice();
    }
  }

  void Ask(std::int64_t id, bool cancel) {
    plan_request_t request{};
    request.session = random_.Int(1, 2);
    request.request_id = id;
    request.action =
        cancel ? plan_request_t::ACTION_CANCEL : plan_request_t::ACTION_GO;
    request.start_x = RecordedRun::kStart.x + (random_.OneIn(3) ? 5 : 0);
    request.start_y = RecordedRun::kStart.y;
    request.goal_x = RecordedRun::kGoal.x;
    request.goal_y = RecordedRun::kGoal.y;
    run_.Say(request);
  }

  // Somebody speaks as a planner, or as another one.
  void SayBaseline() {
    const auto said = Said<baseline_t>(run_.messages());
    if (said.empty()) return;
    baseline_t baseline = AnyOf(said);
    baseline.session += random_.Int(0, 1);
    if (random_.OneIn(3)) bus::SetWaypoints(baseline, AnyRoute());
    if (random_.OneIn(2)) {
      baseline.baseline_digest = BaselineDigest(
          baseline.request_id, baseline.map_id, bus::WaypointsOf(baseline));
    }
    if (random_.OneIn(6)) {
      baseline.status = random_.OneIn(2) ? baseline_t::STATUS_NO_ROUTE
                                         : baseline_t::STATUS_CANCELLED;
    }
    run_.Say(baseline);
  }

  void SayPose() {
    const auto deployed = run_.Deployed();
    if (!deployed) return;
    const Route route = bus::WaypointsOf(*deployed);
    pose_t pose{};
    pose.session = random_.Int(2, 3);
    const Cell cell =
        route.empty() || random_.OneIn(3) ? AnyCell() : AnyOf(route);
    pose.pose_x = cell.x;
    pose.pose_y = cell.y;
    pose.deployed_session = deployed->session + (random_.OneIn(8) ? 1 : 0);
    pose.deployed_route_seq = deployed->route_seq - (random_.OneIn(8) ? 1 : 0);
    run_.Say(pose);
  }

  // As it was said, whatever became of it.
  void SayAgain() {
    const Messages all = run_.messages();
    for (int tries = 0; tries < 20; ++tries) {
      const bus::RawMessage& message = AnyOf(all);
      if (message.channel == bus::Channel::kAdvice ||
          message.channel == bus::Channel::kBaseline ||
          message.channel == bus::Channel::kPose ||
          message.channel == bus::Channel::kPlanRequest) {
        return run_.SayAgain(message);
      }
    }
  }

  Cell AnyCell() { return {random_.Int(-2, 165), random_.Int(-2, 125)}; }
  Route AnyRoute() {
    Route route = {RecordedRun::kStart};
    for (int more = random_.Int(0, 3); more > 0; --more) {
      route.push_back(random_.OneIn(2) ? Cell{random_.Int(60, 100), 29}
                                       : AnyCell());
    }
    route.push_back(RecordedRun::kGoal);
    return route;
  }

  // Three advisors with the same few numbers, who say yes and no at once.
  void SayAdvice() {
    const auto baselines = Said<baseline_t>(run_.messages());
    const auto deployed = run_.Deployed();
    if (baselines.empty() || !deployed) return;
    if (random_.OneIn(3)) return SayTrueAdvice(*deployed);
    const baseline_t baseline =
        random_.OneIn(5) ? AnyOf(baselines) : baselines.back();
    advice_t advice = run_.AdviceFor(baseline, AnyRoute());
    advice.session = random_.Int(77, 79);
    advice.advisor = random_.OneIn(2) ? "one" : "other";
    advice.attempt = random_.Int(1, 4);
    advice.candidate = random_.Int(0, 1);
    advice.kind = static_cast<std::int8_t>(
        random_.OneIn(2) ? int{advice_t::KIND_PROPOSE} : random_.Int(0, 5));
    advice.answer_text = random_.OneIn(2) ? "Yes" : "No";
    if (random_.OneIn(3)) {
      const Route route = bus::WaypointsOf(*deployed);
      advice.anchor_session = deployed->session;
      advice.anchor_route_seq =
          deployed->route_seq - (random_.OneIn(4) ? 1 : 0);
      advice.anchor_index = random_.Int(-1, 150);
      const Cell anchor = route.empty() ? AnyCell() : AnyOf(route);
      advice.anchor_x = anchor.x;
      advice.anchor_y = anchor.y;
    }
    if (random_.OneIn(20)) advice.map_id ^= 1;
    if (random_.OneIn(20)) advice.request_id = random_.Int(99, 105);
    run_.Say(advice);
  }

  // For what is in force, over the top of the bar.
  void SayTrueAdvice(const deployed_t& deployed) {
    baseline_t baseline{};
    baseline.request_id = deployed.request_id;
    baseline.map_id = deployed.map_id;
    baseline.baseline_digest = deployed.baseline_digest;
    const Cell start = {deployed.start_x, deployed.start_y};
    const int top = random_.Int(20, 29);
    advice_t advice = run_.AdviceFor(
        baseline, {start, {69, top}, {90, top}, RecordedRun::kGoal});
    advice.anchor_x = start.x;
    advice.anchor_y = start.y;
    advice.kind = advice_t::KIND_PROPOSE;
    run_.Say(advice);
  }

  Random random_;
  double margin_;
  RecordedRun run_;
};

TEST(Contradictions, EachStepIsAuditedWithTheSameOutcome) {
  std::int64_t accepted = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Messages messages = Liars(seed).Play();
    const Audit audit = AuditOfRecording(messages);
    EXPECT_TRUE(audit.passed()) << "seed " << seed << ": " << Text(audit);
    EXPECT_EQ(audit.steps, std::ssize(Said<gate_step_t>(messages)));
    EXPECT_EQ(audit.lookups_given, 0);
    EXPECT_EQ(audit.verdicts + audit.deployed, DecisionsIn(messages));
    accepted += std::ranges::count(Said<verdict_t>(messages),
                                   std::int16_t{verdict_t::CODE_ACCEPTED},
                                   &verdict_t::code);
  }
  EXPECT_GT(accepted, 60);
}

// ---- Replay ----

// What a gate of its own says of the journal of a session; it hears the maps.
class JournalReplay : public bus::Transport {
 public:
  JournalReplay(const Messages& messages, std::int64_t session, double margin)
      : out_(*this, session),
        node_({.margin = margin, .session = session}, out_) {
    bool begun = false;
    for (const bus::RawMessage& message : messages) {
      const bool is_step = message.channel == bus::Channel::kGateStep;
      if (!is_step && message.channel != bus::Channel::kMapHeader &&
          message.channel != bus::Channel::kMapTile) {
        continue;
      }
      const bool begins =
          is_step && !begun &&
          bus::Decode<gate_step_t>(message.bytes)->session == session;
      if (begins) said_.clear();
      begun |= begins;
      node_.Receive(message, now_);
      now_ += milliseconds(1);
      node_.Advance(now_);
    }
  }

  const Messages& said() const { return said_; }

 private:
  bool Publish(bus::Channel channel,
               std::span<const std::uint8_t> bytes) override {
    said_.push_back({channel, {bytes.begin(), bytes.end()}});
    return true;
  }

  Messages said_;
  bus::Outbox out_;
  bus::Time now_{std::chrono::hours(7)};
  verifier::VerifierNode node_;
};

// What one gate decided and wrote down, each once, without its stamps.
std::vector<std::vector<std::uint8_t>> DecidedBy(const Messages& messages,
                                                 std::int64_t session) {
  std::vector<std::vector<std::uint8_t>> decided;
  std::int64_t last = 0;
  for (const bus::RawMessage& message : messages) {
    if (message.channel == bus::Channel::kVerdict) {
      const auto verdict = *bus::Decode<verdict_t>(message.bytes);
      if (verdict.session == session) decided.push_back(Essence(verdict));
    } else if (message.channel == bus::Channel::kDeployed) {
      const auto deployed = *bus::Decode<deployed_t>(message.bytes);
      if (deployed.session != session || deployed.decision == last) continue;
      last = deployed.decision;
      decided.push_back(Essence(deployed));
    } else if (message.channel == bus::Channel::kGateStep) {
      const auto step = *bus::Decode<gate_step_t>(message.bytes);
      if (step.session == session) decided.push_back(Essence(step));
    }
  }
  return decided;
}

TEST(Contradictions, AJournalIsReplayedExactly) {
  std::size_t decided = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Liars liars(seed);
    const Messages messages = liars.Play();
    std::set<std::int64_t> sessions;
    for (const auto& step : Said<gate_step_t>(messages)) {
      sessions.insert(step.session);
    }
    for (const std::int64_t session : sessions) {
      const JournalReplay replay(messages, session, liars.margin());
      const auto recorded = DecidedBy(messages, session);
      EXPECT_TRUE(DecidedBy(replay.said(), session) == recorded)
          << "seed " << seed << ", session " << session;
      decided += recorded.size();
    }
  }
  EXPECT_GT(decided, 500U);
}

// ---- What somebody changed ----

struct Change {
  const char* what;
  std::function<void(gate_step_t&)> make;
  std::function<bool(const gate_step_t&)> applies = [](const gate_step_t&) {
    return true;
  };
};

bool IsAdvice(const gate_step_t& step) {
  return step.kind == gate_step_t::KIND_ADVICE;
}

// Puts other bytes in place of the event's, as whoever forges a journal would.
void SetBytes(gate_step_t& step, std::vector<std::uint8_t> bytes) {
  step.num_bytes = static_cast<std::int32_t>(bytes.size());
  step.event_bytes = std::move(bytes);
  step.bytes_digest = BytesDigest(step.event_bytes);
}

const std::vector<Change>& Changes() {
  static const std::vector<Change> changes = {
      {"earlier",
       [](auto& step) {
         step.now_us = -1;
       },
       [](const auto& step) {
         return step.step > 1;
       }},
      {"kind",
       [](auto& step) {
         step.kind = static_cast<std::int8_t>(step.kind % 7 + 1);
       }},
      {"lookup",
       [](auto& step) {
         step.lookup = static_cast<std::int8_t>((step.lookup + 1) % 5);
       }},
      {"sender",
       [](auto& step) {
         ++step.event_session;
       }},
      {"number of the message",
       [](auto& step) {
         ++step.event_seq;
       }},
      {"digest of the message",
       [](auto& step) {
         ++step.event_digest;
       },
       [](const auto& step) {
         return !IsAdvice(step);
       }},
      {"request",
       [](auto& step) {
         ++step.request_id;
       }},
      {"cancelled",
       [](auto& step) {
         step.request_cancelled ^= 1;
       }},
      {"planner",
       [](auto& step) {
         ++step.answered_by;
       }},
      {"map",
       [](auto& step) {
         ++step.map_id;
       }},
      {"baseline",
       [](auto& step) {
         ++step.baseline_digest;
       }},
      {"baseline's planner",
       [](auto& step) {
         ++step.baseline_session;
       }},
      {"route",
       [](auto& step) {
         ++step.route_seq;
       }},
      {"x",
       [](auto& step) {
         ++step.place_x;
       }},
      {"y",
       [](auto& step) {
         ++step.place_y;
       }},
      {"index",
       [](auto& step) {
         ++step.place_index;
       }},
      {"on the route",
       [](auto& step) {
         step.place_on_route ^= 1;
       }},
      {"speed",
       [](auto& step) {
         step.place_speed = 1;
       }},
      {"age",
       [](auto& step) {
         ++step.place_age_us;
       }},
      {"dwell",
       [](auto& step) {
         ++step.dwell_end_us;
       }},
      {"decision",
       [](auto& step) {
         ++step.decision;
       }},
      {"core before",
       [](auto& step) {
         ++step.core_before;
       }},
      {"number of decisions",
       [](auto& step) {
         ++step.num_decisions;
       }},
      {"decisions",
       [](auto& step) {
         ++step.decisions_digest;
       }},
      {"core after",
       [](auto& step) {
         ++step.core_after;
       }},
      {"digest of the bytes",
       [](auto& step) {
         ++step.bytes_digest;
       }},
      {"step",
       [](auto& step) {
         step.step += 1'000;
       }},
      {"bytes that are no message",
       [](auto& step) {
         step.event_bytes.pop_back();
         SetBytes(step, step.event_bytes);
       },
       [](const auto& step) {
         return step.num_bytes > 0;
       }},
      {"another attempt",
       [](auto& step) {
         auto advice = bus::Decode<advice_t>(step.event_bytes).value();
         ++advice.attempt;
         SetBytes(step, bus::Encode(advice));
       },
       [](const auto& step) {
         return IsAdvice(step);
       }},
      {"another baseline",
       [](auto& step) {
         auto baseline = bus::Decode<baseline_t>(step.event_bytes).value();
         baseline.waypoint_x.back() -= 1;
         SetBytes(step, bus::Encode(baseline));
       },
       [](const auto& step) {
         if (step.kind != gate_step_t::KIND_BASELINE) return false;
         return bus::Decode<baseline_t>(step.event_bytes)->num_waypoints > 0;
       }},
  };
  return changes;
}

// Steps of a run with one of them changed; nothing where no step can be.
std::optional<Messages> WithChange(const Messages& messages,
                                   const Change& change, Random& random) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (messages[i].channel == bus::Channel::kGateStep &&
        change.applies(*bus::Decode<gate_step_t>(messages[i].bytes))) {
      places.push_back(i);
    }
  }
  if (places.empty()) return std::nullopt;
  Messages changed = messages;
  bus::RawMessage& message = changed[places[static_cast<std::size_t>(
      random.Int(0, static_cast<int>(places.size()) - 1))]];
  auto step = *bus::Decode<gate_step_t>(message.bytes);
  change.make(step);
  message.bytes = bus::Encode(step);
  return changed;
}

TEST(Contradictions, EveryChangeOfAStepIsAFinding) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Messages messages = Liars(seed).Play();
    Random random(seed);
    for (const Change& change : Changes()) {
      const auto changed = WithChange(messages, change, random);
      ASSERT_TRUE(changed) << change.what << ", seed " << seed;
      EXPECT_FALSE(AuditOfRecording(*changed).clean())
          << change.what << ", seed " << seed;
    }
  }
}

TEST(Contradictions, AStepThatIsThereTwiceAndDiffersIsAFinding) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Messages messages = Liars(seed).Play();
    Random random(seed);
    const auto changed = WithChange(messages, Changes()[0], random);
    ASSERT_TRUE(changed);
    for (const bus::RawMessage& message : *changed) {
      if (message.channel == bus::Channel::kGateStep) {
        messages.push_back(message);
      }
    }
    const Audit audit = AuditOfRecording(messages);
    ASSERT_EQ(audit.num_findings, 1) << "seed " << seed << ": " << Text(audit);
    EXPECT_EQ(audit.findings[0].kind, Finding::Kind::kConflict);
  }
}

}  // namespace
}  // namespace terra::logger

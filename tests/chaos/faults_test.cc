// Each fault of terra-chaos: that it is what it says, byte by byte, and what
// the gate makes of it.
#include "chaos/faults.h"

#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/advice_receiver.h"
#include "bus/codec.h"
#include "bus/map_exchange.h"
#include "chaos/chaos_node.h"
#include "planner/coarse_lattice.h"
#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "terrain/route_cost.h"
#include "terrain/segment.h"
#include "tests/support/map_messages.h"
#include "verifier/verifier_node.h"

namespace terra::chaos {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::verdict_t;
using ::testing::IsSubsetOf;

constexpr Cell kStart = {5, 60};
constexpr Cell kGoal = {155, 60};
constexpr std::int64_t kOwnSession = 77;
constexpr std::int64_t kOtherSession = 88;

// Ground with a costly bar and a wall, so that there is something to win and
// something to run into.
bus::MapPtr WalledMap() {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(10);
  ids.block(50, 110, 70, 5).setConstant(11);
  TerrainMap map =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  const std::int64_t id = MapId(map);
  return std::make_shared<const bus::MapInForce>(
      bus::MapInForce{std::move(map), id});
}

baseline_t PlannedBaseline(const bus::MapInForce& map, std::int64_t request) {
  const planner::LatticePlan plan =
      planner::PlanOnLattice(map.map, kStart, kGoal, {.stride = 20});
  baseline_t baseline{};
  baseline.session = 5;
  baseline.seq = request;
  baseline.request_id = request;
  baseline.start_x = kStart.x;
  baseline.start_y = kStart.y;
  baseline.goal_x = kGoal.x;
  baseline.goal_y = kGoal.y;
  baseline.map_id = map.map_id;
  baseline.planner = "planner";
  baseline.status = baseline_t::STATUS_OK;
  bus::SetWaypoints(baseline, plan.waypoints);
  baseline.baseline_digest =
      BaselineDigest(request, map.map_id, plan.waypoints);
  baseline.baseline_cost = plan.cost;
  return baseline;
}

Attacker InformedAttacker(std::uint64_t seed) {
  Attacker attacker({"chaos", kOwnSession, bus::ChannelNames(), seed});
  attacker.SetTime(1'800'000'000'000'000);
  const bus::MapPtr map = WalledMap();
  attacker.Learn(PlannedBaseline(*map, 10), map);
  attacker.Learn(PlannedBaseline(*map, 11), map);
  Attacker other({"victim", kOtherSession, bus::ChannelNames(), 1});
  other.Learn(PlannedBaseline(*map, 11), map);
  attacker.Overhear(Attacker::Bytes(other.Honest()));
  return attacker;
}

// A datagram as the advice bus sees it.
struct Seen {
  Datagram datagram;
  std::optional<bus::LcmDatagram> message;
  std::optional<advice_t> advice;  // When well-formed.
};

Seen Look(const Datagram& datagram) {
  Seen seen{datagram, {}, {}};
  seen.message = bus::ParseLcmDatagram(seen.datagram);
  if (seen.message && seen.message->channel == "TERRA_ADVICE") {
    const auto advice = bus::Decode<advice_t>(seen.message->payload);
    if (advice) seen.advice = *advice;
  }
  return seen;
}

bool IsFragment(const Seen& seen) {
  return seen.datagram.size() > 4 && seen.datagram[3] == '3';
}

RouteWalk Walk(const Seen& seen) {
  return WalkRoute(WalledMap()->map, bus::WaypointsOf(*seen.advice));
}

bool KeyIsGood(const advice_t& advice) {
  const bus::MapPtr map = WalledMap();
  const baseline_t baseline = PlannedBaseline(*map, 11);
  return advice.request_id == 11 && advice.map_id == map->map_id &&
         advice.baseline_digest == baseline.baseline_digest &&
         advice.anchor_index == 0 && advice.anchor_x == kStart.x &&
         advice.anchor_y == kStart.y;
}

bool RouteIsGood(const Seen& seen) {
  const Route route = bus::WaypointsOf(*seen.advice);
  return route.size() >= 2 && route.front() == kStart &&
         route.back() == kGoal && Walk(seen).feasible();
}

bool IsBad(const Seen& seen) {
  return !seen.advice.has_value();
}

struct Expectation {
  /// What every datagram of the fault shows.
  std::function<bool(const Seen&)> shows;
  /// The codes that the gate may give, and gives at least one of; none = it
  /// says nothing.
  std::set<std::string> codes;
};

const std::map<std::string_view, Expectation>& Expectations() {
  const auto has_route_fault = [](RouteFault fault) {
    return [fault](const Seen& seen) {
      return KeyIsGood(*seen.advice) && Walk(seen).fault == fault;
    };
  };
  const auto good = [](const Seen& seen) {
    return KeyIsGood(*seen.advice) && RouteIsGood(seen);
  };
  const double best = [] {
    Attacker attacker = InformedAttacker(1);
    return WalkRoute(attacker.map(), attacker.best()).cost;
  }();
  static const std::map<std::string_view, Expectation> all = {
      {"honest", {good, {"accepted", "not_best"}}},
      {"through-obstacles",
       {has_route_fault(RouteFault::kObstacle), {"obstacle"}}},
      {"jumps",
       {[](const Seen& seen) {
          const Cell jump = bus::WaypointsOf(*seen.advice)[1];
          return KeyIsGood(*seen.advice) && !WalledMap()->map.Contains(jump);
        },
        {"out_of_bounds", "obstacle"}}},
      {"duplicated-points",
       {[good](const Seen& seen) {
          return good(seen) &&
                 seen.advice->waypoint_x[0] == seen.advice->waypoint_x[1];
        },
        {"accepted", "not_best"}}},
      {"huge-routes",
       {[](const Seen& seen) {
          return IsBad(seen) || seen.advice->num_waypoints >= 2'047;
        },
        {"work_limit", "not_cheaper"}}},
      {"too-few-points",
       {[](const Seen& seen) {
          return seen.advice->num_waypoints < 2;
        },
        {"too_few_waypoints"}}},
      {"wrong-start",
       {[best](const Seen& seen) {
          return KeyIsGood(*seen.advice) && Walk(seen).cost < best &&
                 bus::WaypointsOf(*seen.advice).front() != kStart;
        },
        {"start_mismatch"}}},
      {"wrong-goal",
       {[best](const Seen& seen) {
          return KeyIsGood(*seen.advice) && Walk(seen).cost < best &&
                 bus::WaypointsOf(*seen.advice).back() != kGoal;
        },
        {"goal_mismatch"}}},
      {"dearer-routes", {good, {"not_cheaper"}}},
      {"ties",
       {[](const Seen& seen) {
          return bus::WaypointsOf(*seen.advice) ==
                 bus::WaypointsOf(PlannedBaseline(*WalledMap(), 11));
        },
        {"not_cheaper"}}},
      {"wrong-request",
       {[](const Seen& seen) {
          return seen.advice->request_id != 11 && RouteIsGood(seen);
        },
        {}}},
      {"wrong-map",
       {[](const Seen& seen) {
          return seen.advice->map_id != WalledMap()->map_id &&
                 RouteIsGood(seen);
        },
        {}}},
      {"wrong-baseline",
       {[](const Seen& seen) {
          return !KeyIsGood(*seen.advice) && RouteIsGood(seen);
        },
        {}}},
      {"wrong-anchor",
       {[](const Seen& seen) {
          return !KeyIsGood(*seen.advice) && RouteIsGood(seen);
        },
        {"late", "start_mismatch"}}},
      {"late-advice",
       {[](const Seen& seen) {
          return seen.advice->request_id == 10 && RouteIsGood(seen);
        },
        {"stale_request"}}},
      {"stale-seq", {good, {"accepted", "not_best"}}},
      {"same-attempt",
       {[](const Seen& seen) {
          return seen.advice->kind == advice_t::KIND_RETAIN ||
                 RouteIsGood(seen);
        },
        {"retained", "accepted", "not_best"}}},
      {"replay",
       {[](const Seen& seen) {
          return seen.advice->session == kOtherSession;
        },
        {"accepted"}}},
      {"impersonate",
       {[](const Seen& seen) {
          return seen.advice->session == kOtherSession &&
                 seen.advice->advisor == "victim" && !RouteIsGood(seen);
        },
        {"obstacle"}}},
      {"clock-lies",
       {[good](const Seen& seen) {
          return good(seen) && seen.advice->utime != 1'800'000'000'000'000;
        },
        {"accepted", "not_best"}}},
      {"cost-lies",
       {[good](const Seen& seen) {
          return good(seen) &&
                 !(seen.advice->spend_usd >= 0 && seen.advice->spend_usd < 1e9);
        },
        {"accepted", "not_best"}}},
      {"unknown-kind",
       {[good](const Seen& seen) {
          return good(seen) && (seen.advice->kind < advice_t::KIND_RETAIN ||
                                seen.advice->kind > advice_t::KIND_FAILED);
        },
        {"malformed_message"}}},
      {"forged-deployed",
       {[](const Seen& seen) {
          return seen.message->channel == "TERRA_DEPLOYED" ||
                 seen.message->channel == "TERRA_BASELINE";
        },
        {}}},
      {"garbage", {IsBad, {}}},
      {"truncated", {IsBad, {}}},
      {"hostile-counts", {IsBad, {}}},
      {"hostile-strings", {IsBad, {}}},
      {"version-skew", {IsBad, {}}},
      {"no-channel-end", {IsBad, {}}},
      {"oversize",
       {[](const Seen& seen) {
          return IsBad(seen) && seen.datagram.size() > 1'000;
        },
        {}}},
      {"half-fragments", {IsFragment, {}}},
      {"offset-wrap", {IsFragment, {}}},
      {"slow-drip", {IsFragment, {}}},
  };
  return all;
}

// A gate that holds map and baseline, and what it says.
class Gate : public bus::Transport {
 public:
  Gate() : out_(*this, 9), node_({}, out_) {
    const bus::MapPtr map = WalledMap();
    terra_msg::map_header_t header = bus::MakeMapHeader(map->map);
    header.session = 4;
    header.seq = 1;
    Hear(header);
    Hear(testing::AllTiles(map->map));
    for (const std::int64_t request : {10, 11}) {
      Hear(PlannedBaseline(*map, request));
    }
    said_.clear();
  }

  /// What the advice bus would hand over.
  void Take(const Datagram& datagram) {
    const auto message = bus::ParseLcmDatagram(datagram);
    if (message && message->channel == "TERRA_ADVICE") {
      // (each after a pause that no budget forbids)
      now_ += std::chrono::milliseconds(10);
      node_.OnAdviceBytes(1, message->payload, now_);
      node_.Advance(now_);
    }
  }
  const std::vector<verdict_t>& said() const { return said_; }

  bool Publish(bus::Channel channel,
               std::span<const std::uint8_t> bytes) override {
    if (channel == bus::Channel::kVerdict) {
      said_.push_back(bus::Decode<verdict_t>(bytes).value());
    }
    return true;
  }

 private:
  template <typename T>
  void Hear(const T& message) {
    node_.Receive({bus::MessageTraits<T>::kChannel, bus::Encode(message)},
                  now_);
  }

  bus::Time now_{std::chrono::hours(1)};
  std::vector<verdict_t> said_;
  bus::Outbox out_;
  verifier::VerifierNode node_;
};

TEST(Faults, EachHasAnExpectationHere) {
  for (const Fault& fault : AllFaults()) {
    const bool own_test = fault.name == "silence" || fault.name == "bit-flips";
    EXPECT_TRUE(own_test || Expectations().count(fault.name) == 1)
        << fault.name;
    EXPECT_EQ(FindFault(fault.name), &fault);
  }
  EXPECT_EQ(FindFault("sloth"), nullptr);
}

TEST(Faults, EachEmitsWhatItSays) {
  for (const auto& [name, expected] : Expectations()) {
    Attacker attacker = InformedAttacker(1);
    for (int i = 0; i < 200; ++i) {
      const auto datagrams = FindFault(name)->make(attacker);
      EXPECT_FALSE(datagrams.empty()) << name;
      for (const Datagram& datagram : datagrams) {
        ASSERT_TRUE(expected.shows(Look(datagram))) << name << ", number " << i;
      }
    }
  }
}

TEST(Faults, TheGateSaysOfEachWhatItIsAndAcceptsNoLie) {
  for (const auto& [name, expected] : Expectations()) {
    Attacker attacker = InformedAttacker(2);
    Gate gate;
    for (int i = 0; i < 200; ++i) {
      for (const Datagram& datagram : FindFault(name)->make(attacker)) {
        gate.Take(datagram);
      }
    }
    std::set<std::string> codes;
    for (const verdict_t& verdict : gate.said()) {
      codes.insert(std::string(
          verifier::CodeName(static_cast<verifier::Code>(verdict.code))));
    }
    EXPECT_THAT(codes, IsSubsetOf(expected.codes)) << name;
    EXPECT_EQ(codes.empty(), expected.codes.empty()) << name;
    if (FindFault(name)->outcome == Outcome::kMustNotPass) {
      EXPECT_EQ(codes.count("accepted"), 0U) << name;
    }
  }
}

TEST(Faults, BitFlipsAreOneToThreeBitsOfAGoodMessage) {
  Attacker attacker = InformedAttacker(1);
  Attacker twin = InformedAttacker(1);
  for (int i = 0; i < 200; ++i) {
    const Datagram flipped = BitFlips(attacker).front();
    const Datagram good = twin.Say(twin.Honest());
    ASSERT_EQ(flipped.size(), good.size());
    int bits = 0;
    for (std::size_t at = 0; at < good.size(); ++at) {
      bits += __builtin_popcount(static_cast<unsigned>(flipped[at] ^ good[at]));
    }
    EXPECT_LE(bits, 3);
  }
}

TEST(Faults, SilenceSaysNothing) {
  Attacker attacker = InformedAttacker(1);
  EXPECT_TRUE(FindFault("silence")->make(attacker).empty());
}

TEST(Faults, HostileCountsAreNegativeHugeAndOneTooMany) {
  Attacker attacker = InformedAttacker(1);
  std::set<std::string> complaints;
  for (int i = 0; i < 200; ++i) {
    const Datagram datagram = HostileCounts(attacker).front();
    const auto message = bus::ParseLcmDatagram(datagram);
    complaints.insert(bus::Decode<advice_t>(message->payload).error().message);
  }
  for (const char* count : {"count -1,", "count 500000000,",
                            "count 2147483647,", "count -2147483648,"}) {
    EXPECT_THAT(complaints, ::testing::Contains(::testing::HasSubstr(count)));
  }
  EXPECT_EQ(complaints.size(), 5U) << "and one waypoint too many";
}

// An attacker of the deployed bus that overheard two messages there.
Attacker DeployedBusAttacker() {
  Attacker attacker({"chaos", kOwnSession, bus::ChannelNames(), 1, true});
  const bus::MapPtr map = WalledMap();
  attacker.Learn(PlannedBaseline(*map, 11), map);
  terra_msg::plan_request_t request{};
  request.request_id = 11;
  attacker.OverhearDeployed(
      {bus::Channel::kBaseline, bus::Encode(PlannedBaseline(*map, 11))});
  attacker.OverhearDeployed({bus::Channel::kPlanRequest, bus::Encode(request)});
  return attacker;
}

TEST(Faults, OnTheDeployedBusTheyAreOfWhatWasOverheardThere) {
  Attacker attacker = DeployedBusAttacker();
  const baseline_t baseline = PlannedBaseline(*WalledMap(), 11);
  for (const char* name : {"truncated", "bit-flips", "hostile-counts",
                           "hostile-strings", "version-skew"}) {
    std::set<std::string> channels;
    for (int i = 0; i < 200; ++i) {
      const Datagram datagram = FindFault(name)->make(attacker).at(0);
      const auto message = bus::ParseLcmDatagram(datagram);
      ASSERT_TRUE(message) << name;
      channels.emplace(message->channel);
      const std::vector<std::uint8_t> payload(message->payload.begin(),
                                              message->payload.end());
      EXPECT_NE(payload, bus::Encode(baseline)) << name;
    }
    EXPECT_EQ(channels,
              (std::set<std::string>{"TERRA_BASELINE", "TERRA_PLAN_REQUEST"}))
        << name;
  }
}

TEST(Faults, OnTheDeployedBusTheyAreOnEveryChannel) {
  Attacker attacker = DeployedBusAttacker();
  std::set<std::string> channels;
  for (int i = 0; i < 400; ++i) {
    const auto message =
        bus::ParseLcmDatagram(FindFault("oversize")->make(attacker).at(0));
    if (message) channels.emplace(message->channel);
    channels.insert(attacker.AttackedChannel());
  }
  EXPECT_EQ(std::ssize(channels), bus::kNumChannels);
}

TEST(Faults, TheSameSeedMisbehavesTheSame) {
  for (const Fault& fault : AllFaults()) {
    Attacker one = InformedAttacker(5);
    Attacker two = InformedAttacker(5);
    for (int i = 0; i < 20; ++i) {
      ASSERT_EQ(fault.make(one), fault.make(two)) << fault.name;
    }
  }
}

TEST(Faults, WhoKnowsNothingYetSaysOnlyWhatNeedsNoKnowledge) {
  for (const Fault& fault : AllFaults()) {
    if (fault.needs_baseline) continue;
    Attacker ignorant({"chaos", kOwnSession, bus::ChannelNames(), 1});
    for (int i = 0; i < 20; ++i) fault.make(ignorant);
  }
}

TEST(Fragments, AWholeMessageComesApartAndTogether) {
  std::vector<std::uint8_t> payload(1'000);
  for (std::size_t i = 0; i < payload.size(); ++i) {
    payload[i] = static_cast<std::uint8_t>(i);
  }
  const auto fragments = Fragments(3, "CHANNEL", payload, 300);
  ASSERT_EQ(fragments.size(), 4U);
  std::vector<std::uint8_t> together;
  for (const Datagram& fragment : fragments) {
    EXPECT_EQ((std::string{fragment.begin(), fragment.begin() + 4}), "LC03");
    const std::size_t header = 20 + (together.empty() ? 8 : 0);
    together.insert(together.end(),
                    fragment.begin() + static_cast<std::ptrdiff_t>(header),
                    fragment.end());
  }
  EXPECT_EQ(together, payload);
}

}  // namespace
}  // namespace terra::chaos

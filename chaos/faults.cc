#include "chaos/faults.h"

#include <algorithm>
#include <array>

namespace terra::chaos {
namespace {

constexpr Outcome kMayPass = Outcome::kMayPass;
constexpr Outcome kMustNotPass = Outcome::kMustNotPass;

std::vector<Datagram> Nothing(Attacker&) {
  return {};
}

constexpr std::array kFaults = {
    Fault{"silence", "a heartbeat, and never any advice", kMustNotPass, false,
          Nothing},
    Fault{"honest", "no fault: the cheapest route; for use with --flood",
          kMayPass, true, Honest},

    Fault{"through-obstacles", "routes over blocked cells", kMustNotPass, true,
          ThroughObstacles},
    Fault{"jumps", "waypoints outside the map, up to the ends of int32",
          kMustNotPass, true, Jumps},
    Fault{"duplicated-points", "each waypoint many times over", kMayPass, true,
          DuplicatedPoints},
    Fault{"huge-routes", "too many waypoints, or too many steps", kMustNotPass,
          true, HugeRoutes},
    Fault{"too-few-points", "routes of one waypoint or none", kMustNotPass,
          true, TooFewPoints},
    Fault{"wrong-start", "routes that begin beside the start", kMustNotPass,
          true, WrongStart},
    Fault{"wrong-goal", "routes that end short of the goal", kMustNotPass, true,
          WrongGoal},
    Fault{"dearer-routes", "routes that cost more than the baseline",
          kMustNotPass, true, DearerRoutes},
    Fault{"ties", "the baseline itself as a proposal", kMustNotPass, true,
          Ties},

    Fault{"wrong-request", "good routes for a request nobody made",
          kMustNotPass, true, WrongRequest},
    Fault{"wrong-map", "good routes for a map nobody has", kMustNotPass, true,
          WrongMap},
    Fault{"wrong-baseline", "good routes for a baseline nobody planned",
          kMustNotPass, true, WrongBaseline},
    Fault{"wrong-anchor", "anchors that are not on the route in force",
          kMustNotPass, true, WrongAnchor},
    // (A gate that has not heard of the new baseline yet rightly takes it.)
    Fault{"late-advice", "good routes for the baseline before", kMayPass, true,
          LateAdvice},
    Fault{"stale-seq", "seq that stands still, runs back or overflows",
          kMayPass, true, StaleSeq},
    // (Each content is judged, so that a copied number silences nobody.)
    Fault{"same-attempt", "a second thought under the number of the first",
          kMayPass, true, SameAttempt},
    Fault{"replay", "byte for byte what another advisor said", kMayPass, false,
          Replay},
    Fault{"impersonate", "blocked routes in another advisor's name and session",
          kMustNotPass, true, Impersonate},
    Fault{"clock-lies", "utime of 1970, of the far future, below zero",
          kMayPass, true, ClockLies},
    Fault{"cost-lies", "NaN, infinite and absurd figures about itself",
          kMayPass, true, CostLies},
    Fault{"unknown-kind", "kinds that do not exist", kMustNotPass, true,
          UnknownKind},
    Fault{"forged-deployed",
          "BASELINE and DEPLOYED messages through an obstacle; no advisor's "
          "business on the advice port",
          kMustNotPass, true, ForgedDeployed},

    Fault{"garbage", "random bytes, raw or as an advice message", kMustNotPass,
          false, Garbage},
    Fault{"truncated", "good messages cut anywhere", kMustNotPass, true,
          Truncated},
    Fault{"bit-flips", "good messages with one to three bits wrong", kMayPass,
          true, BitFlips},
    Fault{"hostile-counts", "array counts of -1, 500 million, INT_MAX",
          kMustNotPass, true, HostileCounts},
    Fault{"hostile-strings", "string lengths of 0, -5, INT_MAX, no end",
          kMustNotPass, true, HostileStrings},
    Fault{"version-skew", "messages of another version of the type",
          kMustNotPass, true, VersionSkew},
    Fault{"no-channel-end", "datagrams without an end of the channel name",
          kMustNotPass, false, NoChannelEnd},
    Fault{"oversize", "whole messages of 61 kB to 1 MB", kMustNotPass, true,
          Oversize},
    Fault{"half-fragments", "fragments that are missing, doubled, in disorder",
          kMustNotPass, true, HalfFragments},
    Fault{"offset-wrap",
          "the fragment that crashes whoever reads with liblcm: in 1.3.1 "
          "subscribers of its channel (ADVICE), in 1.5.2 all",
          kMustNotPass, false, OffsetWrap},
    Fault{"slow-drip", "a message of 65,535 fragments that never ends",
          kMustNotPass, false, SlowDrip},
};

}  // namespace

std::span<const Fault> AllFaults() {
  return kFaults;
}

const Fault* FindFault(std::string_view name) {
  const auto* found =
      std::find_if(kFaults.begin(), kFaults.end(), [name](const Fault& fault) {
        return fault.name == name;
      });
  return found == kFaults.end() ? nullptr : found;
}

}  // namespace terra::chaos

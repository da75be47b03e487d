#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "chaos/attacker.h"

namespace terra::chaos {

/// What a gate may make of a fault's messages.
enum class Outcome {
  /// The content is good advice: a gate that reads only the content takes it.
  kMayPass,
  /// A gate that accepts one of these has a hole.
  kMustNotPass,
};

/// One way to misbehave, and the flag of terra-chaos of the same name.
struct Fault {
  std::string_view name;
  std::string_view help;
  Outcome outcome = Outcome::kMustNotPass;
  bool needs_baseline = true;
  /// The datagrams of one misdeed; none where the attacker does not know enough
  /// yet (no obstacle on the map, nobody overheard).
  std::vector<Datagram> (*make)(Attacker&) = nullptr;
};

/// All of them, in the order of --help.
std::span<const Fault> AllFaults();

/// Null when there is none of this name.
const Fault* FindFault(std::string_view name);

// The makers, by what they falsify.

// The proposed route (route_faults.cc).
std::vector<Datagram> ThroughObstacles(Attacker&);
std::vector<Datagram> Jumps(Attacker&);
std::vector<Datagram> DuplicatedPoints(Attacker&);
std::vector<Datagram> HugeRoutes(Attacker&);
std::vector<Datagram> TooFewPoints(Attacker&);
std::vector<Datagram> WrongStart(Attacker&);
std::vector<Datagram> WrongGoal(Attacker&);
std::vector<Datagram> DearerRoutes(Attacker&);
std::vector<Datagram> Ties(Attacker&);

// Everything else that a message says (telling_faults.cc).
std::vector<Datagram> Honest(Attacker&);
std::vector<Datagram> WrongRequest(Attacker&);
std::vector<Datagram> WrongMap(Attacker&);
std::vector<Datagram> WrongBaseline(Attacker&);
std::vector<Datagram> WrongAnchor(Attacker&);
std::vector<Datagram> LateAdvice(Attacker&);
std::vector<Datagram> StaleSeq(Attacker&);
std::vector<Datagram> SameAttempt(Attacker&);
std::vector<Datagram> Replay(Attacker&);
std::vector<Datagram> Impersonate(Attacker&);
std::vector<Datagram> ClockLies(Attacker&);
std::vector<Datagram> CostLies(Attacker&);
std::vector<Datagram> UnknownKind(Attacker&);
std::vector<Datagram> ForgedDeployed(Attacker&);

// The bytes (byte_faults.cc).
std::vector<Datagram> Garbage(Attacker&);
std::vector<Datagram> Truncated(Attacker&);
std::vector<Datagram> BitFlips(Attacker&);
std::vector<Datagram> HostileCounts(Attacker&);
std::vector<Datagram> HostileStrings(Attacker&);
std::vector<Datagram> VersionSkew(Attacker&);
std::vector<Datagram> NoChannelEnd(Attacker&);
std::vector<Datagram> Oversize(Attacker&);
std::vector<Datagram> HalfFragments(Attacker&);
std::vector<Datagram> OffsetWrap(Attacker&);
std::vector<Datagram> SlowDrip(Attacker&);

}  // namespace terra::chaos

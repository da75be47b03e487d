#pragma once

#include <vector>

#include "tests/verifier/gate_trace.h"

namespace terra::verifier {

/// The deployed route, checked by the oracle on the map in force.
OracleCheck CheckDeployed(const Observed& now);

/// Whether request, map and baseline of advice are those in force.
bool SpeaksOfWhatIsInForce(const Observed& now, const AdviceEvent& advice);

/// The cells up to the anchor, then those of the candidate.
/// Pre: the anchor is on the deployed route, the candidate feasible.
Route Joined(const Observed& now, const AdviceEvent& advice);

/// The code that advice of a known kind must get, with one exception: that the
/// whole route may exceed the limits is left out.
/// Pre: SpeaksOfWhatIsInForce.
Code OracleVerdict(const Observed& now, const AdviceEvent& advice);

}  // namespace terra::verifier

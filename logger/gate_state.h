#pragma once

#include "logger/later_decisions.h"
#include "logger/log_contents.h"
#include "logger/replayed_gate.h"
#include "terrain/result.h"

namespace terra::logger {

/// Returns a gate in the state that a DEPLOYED tells, where the log does not
/// hold what led to it. Route and costs are made again from the baseline and
/// the map that it names; only why and when it was deployed is taken for true.
///
/// Its decision and route_seq are its own, not those of the log.
/// Errors: kNotFound when the log does not hold an input, kInvalid when the
///         inputs do not give this state.
Result<ReplayedGate> GateInState(const terra_msg::deployed_t& deployed,
                                 LogContents& contents,
                                 const verifier::GateOptions& options,
                                 const LaterDecisions::Replaced& replaced);

}  // namespace terra::logger

#pragma once

#include "tests/logger/recorded_run.h"

namespace terra::logger {

/// Returns whether a changed message gives the gate and the audit nothing else
/// to decide on than the honest one: the change is in what invariant 6 leaves
/// out, or in what no decision reads.
bool DecidesTheSame(const bus::RawMessage& honest,
                    const bus::RawMessage& changed);

}  // namespace terra::logger

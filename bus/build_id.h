#pragma once

namespace terra::bus {

/// Returns version and git commit, as in "0.1.0+1a2b3c4d5e6f-dirty".
const char* BuildId();

}  // namespace terra::bus

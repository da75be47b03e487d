#pragma once

#include <string>

#include "terrain/result.h"
#include "verifier/gate.h"

namespace CLI {
class App;
}

namespace terra::verifier {

/// Adds what decides of a gate: --margin and --replay-session.
void AddGateOptions(CLI::App& app, GateOptions& options);

/// Reads these options back from what --print-config prints, which a gate sends
/// as its CONFIG. Other options in it do not matter; one that is missing has
/// its default. Reads any text. Errors: no such text; a value that the gate
/// itself refuses.
Result<GateOptions> ReadGateOptions(const std::string& config_text);

}  // namespace terra::verifier

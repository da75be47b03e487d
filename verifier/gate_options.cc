#include "verifier/gate_options.h"

#include <exception>
#include <sstream>

#include <CLI/CLI.hpp>

#include "bus/number_range.h"

namespace terra::verifier {

void AddGateOptions(CLI::App& app, GateOptions& options) {
  app.add_option("--margin", options.margin,
                 "a candidate must save more than this, in cost")
      ->check(bus::InRange(0.0, 1e9));
  app.add_option("--replay-session", options.session,
                 "take anchors and poses of this session of a gate for one's "
                 "own, to hear the log of that one; never on a robot");
}

Result<GateOptions> ReadGateOptions(const std::string& config_text) {
  GateOptions options;
  CLI::App app;
  AddGateOptions(app, options);
  app.allow_config_extras(CLI::config_extras_mode::ignore);
  std::istringstream text(config_text);
  try {
    app.parse_from_stream(text);
  } catch (const std::exception& error) {  // CLI11's own, or a number's.
    return Error{ErrorCode::kInvalid, error.what()};
  }
  return options;
}

}  // namespace terra::verifier

// Configuration files and LCM URLs, as the programs read them: bad ones are
// refused with a word. The first byte chooses.

#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

#include "advisor/advisor_options.h"
#include "bus/lcm_url.h"
#include "bus/process.h"
#include "bus/toml_config.h"
#include "tests/fuzz/fuzz.h"

namespace {

// The options of an advisor process. They are made once, which takes longer
// than to parse most inputs.
struct Program {
  Program() {
    terra::bus::AddBusOptions(app, bus);
    terra::advisor::AddAdvisorOptions(app, advisor);
    terra::bus::ReadConfigAsToml(app);
    app.allow_config_extras(CLI::config_extras_mode::error);
  }

  CLI::App app;
  terra::bus::BusOptions bus;
  terra::advisor::AdvisorOptions advisor;
};

void CheckConfig(std::string_view text) {
  static Program program;
  program.app.clear();
  program.bus = {};
  program.advisor = {};
  std::istringstream file{std::string(text)};
  try {
    program.app.parse_from_stream(file);
  } catch (const CLI::ParseError& error) {
    terra::fuzz::Require(*error.what() != '\0', "a refusal says why");
    return;
  }
  const auto complete = program.bus.Complete();
  terra::fuzz::RequireReason(complete);
  if (complete) terra::fuzz::RequireReason(program.bus.Channels());
}

void CheckUrl(std::string_view text) {
  const auto url = terra::bus::ParseLcmUrl(std::string(text));
  const auto advice = terra::bus::AdviceUrlFor(std::string(text));
  if (!advice) return;
  terra::fuzz::Require(url.ok() && terra::bus::ParseLcmUrl(*advice).ok(),
                       "an advice URL comes from a URL, and is one");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = terra::fuzz::Text(data + 1, size - 1);
  if (data[0] % 2 == 0) {
    CheckConfig(text);
  } else {
    CheckUrl(text);
  }
  return 0;
}

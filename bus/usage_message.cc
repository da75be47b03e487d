#include "bus/usage_message.h"

#include <CLI/CLI.hpp>

namespace terra::bus {
namespace {

bool IsKind(const CLI::Error& error, CLI::ExitCodes kind) {
  return error.get_exit_code() == static_cast<int>(kind);
}

// " --a --b", the options among the arguments that nothing takes.
std::string UnknownOptions(const CLI::App& app) {
  std::string options;
  for (const std::string& extra : app.remaining(true)) {
    if (extra.starts_with('-')) {
      options += ' ' + extra.substr(0, extra.find('='));
    }
  }
  return options;
}

// ": a, b, c", the subcommands that could go on; empty where none is missing.
std::string MissingSubcommands(const CLI::App* app) {
  while (!app->get_subcommands().empty()) {
    app = app->get_subcommands().front();
  }
  std::string names;
  if (app->get_require_subcommand_min() > 0) {
    for (const CLI::App* command : app->get_subcommands({})) {
      names += (names.empty() ? ": " : ", ") + command->get_name();
    }
  }
  return names;
}

// "FILE: there is no option KEY", for a key of the configuration that nothing
// takes; else what CLI11 says of the file.
std::string ConfigMessage(const CLI::App& app, std::string message) {
  constexpr std::string_view kUnknownKey = "INI was not able to parse ";
  if (message.starts_with(kUnknownKey)) {
    message = "there is no option " + message.substr(kUnknownKey.size());
  }
  const CLI::Option* config = app.get_config_ptr();
  return config == nullptr || config->empty()
             ? message
             : config->results().front() + ": " + message;
}

}  // namespace

std::string UsageMessage(const CLI::App* app, const CLI::Error& error) {
  std::string message = error.what();
  if (IsKind(error, CLI::ExitCodes::ExtrasError)) {
    const std::string options = UnknownOptions(*app);
    if (!options.empty()) message = "There is no option" + options;
  } else if (IsKind(error, CLI::ExitCodes::RequiredError)) {
    message += MissingSubcommands(app);
  } else if (IsKind(error, CLI::ExitCodes::ConfigError)) {
    message = ConfigMessage(*app, message);
  }
  return message + "\nRun with --help for more information.\n";
}

}  // namespace terra::bus

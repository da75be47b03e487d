#include "bus/usage_message.h"

#include <CLI/CLI.hpp>

namespace terra::bus {

std::string UsageMessage(const CLI::App* app, const CLI::Error& error) {
  std::string options;
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    for (const std::string& extra : app->remaining(true)) {
      if (extra.starts_with('-')) {
        options += ' ' + extra.substr(0, extra.find('='));
      }
    }
  }
  return (options.empty() ? std::string(error.what())
                          : "There is no option" + options) +
         "\nRun with --help for more information.\n";
}

}  // namespace terra::bus

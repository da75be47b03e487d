#pragma once

#include <string>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace terra::bus {

/// What to tell of a command line that cannot be read; for
/// CLI::App::failure_message. Of arguments that no option takes it names the
/// options among them only: what came with them may be a secret ("--api-key
/// KEY"), and output ends up in logs.
std::string UsageMessage(const CLI::App* app, const CLI::Error& error);

}  // namespace terra::bus

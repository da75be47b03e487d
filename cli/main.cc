// terra: the tool for people. Exit codes: 0 done, 1 could not, 2 wrong usage.
#include <exception>
#include <iostream>

#include <CLI/CLI.hpp>

#include "bus/decimal_options.h"
#include "bus/usage_message.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "output/standard_output.h"

namespace {

using terra::cli::kCouldNot;
using terra::cli::kWrongUsage;

void AddCommands(CLI::App& app, int& exit_code) {
  using namespace terra::cli;  // NOLINT(google-build-using-namespace)
  AddPlanCommand(app, exit_code);
  AddOracleCommand(app, exit_code);
  AddVerifyCommand(app, exit_code);
  AddAdviseCommand(app, exit_code);
  AddPromptCommand(app, exit_code);
  AddRenderCommand(app, exit_code);
  AddRequestCommand(app, exit_code);
  AddLogCommand(app, exit_code);
  AddMonitorCommand(app, exit_code);
  AddBenchCommand(app, exit_code);
}

int Run(int argc, char** argv) {
  CLI::App app{
      "Cheaper routes on fine terrain maps beside a planner that searches a "
      "fixed graph.",
      "terra"};
  int exit_code = 0;
  app.set_version_flag("--version", "terra " TERRA_VERSION);
  app.require_subcommand(1);
  app.failure_message(terra::bus::UsageMessage);
  app.footer(
      "Maps: 8-bit PNG of terrain ids, 24-bit PNG in legend colours, MovingAI "
      ".map,\nROS map_server .yaml. Cells are X,Y from the top left corner.\n"
      "'terra COMMAND --help' shows the options of a command and an example.");
  AddCommands(app, exit_code);
  terra::bus::TakeDecimalNumbersOnly(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  terra::ReserveStandardStreams();
  int exit_code = kCouldNot;
  try {
    exit_code = Run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "terra: " << error.what() << "\n";
  }
  return terra::FinishStandardOutput("terra", exit_code);
}

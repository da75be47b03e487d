#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/log_info_output.h"
#include "cli/output.h"
#include "logger/log_info.h"
#include "logger/log_reader.h"

namespace terra::cli {
namespace {

struct InfoArguments {
  std::string file;
  bool json = false;
};

int RunInfo(const InfoArguments& arguments) {
  Result<logger::LogReader> reader = logger::LogReader::Open(arguments.file);
  if (!reader) return Fail(reader.error());
  const logger::LogInfo info = logger::Inspect(*reader);
  if (arguments.json) {
    PrintLogInfoJson(info, std::cout);
  } else {
    PrintLogInfo(info, std::cout);
  }
  if (info.events == 0) {
    return Fail({ErrorCode::kInvalid, arguments.file + " holds no events"});
  }
  return info.intact() ? kDone : kCouldNot;
}

void AddInfo(CLI::App& log, int& exit_code) {
  CLI::App& command = *log.add_subcommand(
      "info",
      "Show channels, counts, rates, gaps and damage; exit 1 if there is any");
  const auto arguments = std::make_shared<InfoArguments>();
  command.add_option("file", arguments->file, "LCM event log")->required();
  command.add_flag("--json", arguments->json, "Print JSON");
  command.footer(
      "Example:\n  terra log info "
      "log/terra-20260131T120000Z-0123abcd.000.lcmlog");
  command.callback([arguments, &exit_code] {
    exit_code = RunInfo(*arguments);
  });
}

}  // namespace

void AddLogCommand(CLI::App& app, int& exit_code) {
  CLI::App& log = *app.add_subcommand("log", "Look into recorded logs");
  log.require_subcommand(1);
  AddInfo(log, exit_code);
}

}  // namespace terra::cli

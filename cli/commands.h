#pragma once

namespace CLI {
class App;
}

namespace terra::cli {

/// One function per subcommand of `terra`, each in its own NAME_command.cc.
/// It adds the subcommand with its options and an example, and a callback that
/// runs it and sets the exit code: 0 done, 1 could not (reason on stderr).
/// Wrong usage (exit 2) is a CLI::ParseError, thrown while options are read.
///
/// Pre: exit_code outlives the app.
void AddPlanCommand(CLI::App& app, int& exit_code);
void AddOracleCommand(CLI::App& app, int& exit_code);
void AddVerifyCommand(CLI::App& app, int& exit_code);
void AddAdviseCommand(CLI::App& app, int& exit_code);
void AddPromptCommand(CLI::App& app, int& exit_code);
void AddRenderCommand(CLI::App& app, int& exit_code);
void AddRequestCommand(CLI::App& app, int& exit_code);
void AddLogCommand(CLI::App& app, int& exit_code);
void AddMonitorCommand(CLI::App& app, int& exit_code);
void AddBenchCommand(CLI::App& app, int& exit_code);

}  // namespace terra::cli

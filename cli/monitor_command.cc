// terra monitor: a live view of the running set.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "bus/advisor_channels.h"
#include "bus/bus.h"
#include "bus/event_loop.h"
#include "bus/log.h"
#include "bus/number_range.h"
#include "bus/process.h"
#include "cli/commands.h"
#include "cli/monitor_node.h"
#include "cli/output.h"
#include "output/standard_output.h"

namespace terra::cli {
namespace {

constexpr char kClearScreen[] = "\033[H\033[2J";

struct MonitorArguments {
  bus::BusOptions bus;
  double duration_s = 0;  // 0 = until Ctrl-C.
};

// A terminal is redrawn in place; a file or pipe gets one view after another.
bool Show(const std::string& view) {
  const bool terminal = ::isatty(STDOUT_FILENO) == 1;
  std::printf("%s%s%s", terminal ? kClearScreen : "", view.c_str(),
              terminal ? "\nCtrl-C ends this view\n" : "\n");
  return FlushStandardOutput().ok();
}

int Watch(MonitorArguments& arguments) {
  const Status completed = arguments.bus.Complete();
  if (!completed) return Fail(completed.error(), kWrongUsage);
  bus::SetLogName("terra");
  if (const std::string notice = arguments.bus.Notice(); !notice.empty()) {
    bus::LogWarning(notice);
  }
  const bus::StopSignal stop;
  const Result<bus::ChannelNames> channels = arguments.bus.Channels();
  if (!channels) return Fail(channels.error(), kWrongUsage);
  bus::Inbox inbox;
  Result<std::unique_ptr<bus::Bus>> opened =
      bus::Bus::Open(arguments.bus.lcm_url, *channels);
  if (!opened) return Fail(opened.error());
  const std::unique_ptr<bus::Bus> bus = *std::move(opened);
  MonitorNode node(
      arguments.duration_s > 0
          ? std::chrono::duration_cast<bus::Duration>(
                std::chrono::duration<double>(arguments.duration_s))
          : bus::Duration::max(),
      Show);
  const Status listening = bus->Listen(node.channels(), inbox);
  if (!listening) return Fail(listening.error());
  bus::EventLoop loop(inbox, stop);
  const Status advisors =
      bus::ListenToAdvisors(arguments.bus, *channels, node, loop);
  if (!advisors) return Fail(advisors.error());
  loop.Run(node);
  return kDone;
}

}  // namespace

void AddMonitorCommand(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("monitor", "Live view of the running processes");
  const auto arguments = std::make_shared<MonitorArguments>();
  bus::AddBusOptions(*command, arguments->bus);
  command
      ->add_option("--for", arguments->duration_s,
                   "ends after so many seconds (default: with Ctrl-C)")
      ->check(bus::InRange(0.0, 1e6))
      ->type_name("S");
  command->footer("example: terra monitor --robot ALPHA");
  command->callback([arguments, &exit_code] {
    exit_code = Watch(*arguments);
  });
}

}  // namespace terra::cli

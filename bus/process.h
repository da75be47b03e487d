#pragma once

#include <functional>
#include <memory>
#include <string>

#include "bus/bus.h"
#include "bus/event_loop.h"
#include "bus/node.h"
#include "terrain/result.h"

namespace CLI {
class App;
}

namespace terra::bus {

/// Where the buses are, and whose; options that every program on the bus has.
struct BusOptions {
  std::string lcm_url;     ///< Empty = LCM_DEFAULT_URL, else kDefaultLcmUrl.
  std::string advice_url;  ///< Empty = AdviceUrlFor the deployed bus.
  std::string robot;
  std::string map_prefix;

  /// Fills in what was left empty, and URLs in full. Errors: a bad URL; an
  /// advice bus apart from the deployed one that is not udpm.
  Status Complete();
  /// Does advice travel on the deployed bus? Pre: Complete.
  bool OneBus() const;
  /// Where the gate's journal goes: JournalUrlFor the deployed bus, or that bus
  /// itself where OneBus. Errors: a port that there is not, or that is the
  /// advice bus's. Pre: Complete.
  Result<std::string> JournalUrl() const;
  /// What whoever starts a program should know about its bus, or nothing.
  std::string Notice() const;
  Result<ChannelNames> Channels() const;
};

/// Adds --lcm-url, --advice-url, --robot and --map-prefix.
void AddBusOptions(CLI::App& app, BusOptions& options);

/// What a process is given to make its node from.
struct ProcessContext {
  const BusOptions& bus;
  const ChannelNames& channels;
  std::string name;  ///< --name
  Outbox& out;       ///< The deployed bus; for advisors the advice bus.
  Inbox& inbox;      ///< For Wake, from the node's own threads.
  EventLoop& loop;   ///< To watch descriptors of the node's own.
};

/// A program that joins the bus.
struct ProcessSpec {
  std::string program;      ///< "terra-map"
  std::string name;         ///< Default of --name: "map".
  std::string description;  ///< What it listens to, publishes, when it exits.
  /// An advisor hears the deployed bus and sends nothing there: all that it
  /// says goes over the advice bus.
  bool is_advisor = false;
  std::function<void(CLI::App&)> add_options;
  /// Called once the options are read and the deployed bus is open.
  std::function<Result<std::unique_ptr<Node>>(ProcessContext&)> make_node;
};

/// Runs a program: options, --config, --print-config, --version; the bus;
/// heartbeat and configuration on it; a clean end on SIGINT and SIGTERM.
/// Returns the exit code: 0 asked to stop, 1 could not go on, 2 wrong usage.
int RunProcess(const ProcessSpec& spec, int argc, char** argv);

}  // namespace terra::bus

#include "bus/process.h"

#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>

#include "base/secrets.h"
#include "bus/advisor_channels.h"
#include "bus/build_id.h"
#include "bus/decimal_options.h"
#include "bus/heartbeat.h"
#include "bus/lcm_url.h"
#include "bus/log.h"
#include "bus/toml_config.h"
#include "bus/usage_message.h"
#include "bus/wire.h"
#include "output/standard_output.h"

namespace terra::bus {
namespace {

constexpr int kCouldNot = 1;
constexpr int kWrongUsage = 2;
constexpr Duration kConfigPeriod = std::chrono::seconds(5);

// An error that ends the program, said once.
int Fail(const std::string& message) {
  LogError(message);
  return kCouldNot;
}

int Serve(const ProcessSpec& spec, const std::string& name,
          const BusOptions& options, const std::string& config) {
  const StopSignal stop;  // before any thread
  const Result<ChannelNames> channels = options.Channels();
  if (!channels) {
    LogError(channels.error().message);
    return kWrongUsage;
  }
  if (const std::string notice = options.Notice(); !notice.empty()) {
    LogWarning(notice);
  }
  Inbox inbox;
  const bool apart = spec.is_advisor && !options.OneBus();
  Result<std::unique_ptr<Bus>> opened = Bus::Open(
      options.lcm_url, *channels, apart ? Use::kHear : Use::kSendAndHear);
  if (!opened) return Fail(opened.error().message);
  const std::unique_ptr<Bus> bus = *std::move(opened);
  std::unique_ptr<Bus> advice_bus;
  if (apart) {
    opened = Bus::Open(options.advice_url, *channels);
    if (!opened) return Fail(opened.error().message);
    advice_bus = *std::move(opened);
  }
  Bus& sends = apart ? *advice_bus : *bus;
  Outbox out(sends, RandomId());
  EventLoop loop(inbox, stop);
  ProcessContext context{options, *channels, name, out, inbox, loop};
  Result<std::unique_ptr<Node>> made = spec.make_node(context);
  ForgetApiKeys();
  if (!made) return Fail(made.error().message);
  const std::unique_ptr<Node> node = *std::move(made);
  if (!node->channels().empty()) {
    const Status listening = bus->Listen(node->channels(), inbox);
    if (!listening) return Fail(listening.error().message);
  }
  const Status advisors = ListenToAdvisors(options, *channels, *node, loop);
  if (!advisors) return Fail(advisors.error().message);
  Heartbeat heartbeat(name, config, out, sends, *bus, inbox);
  loop.AfterTurn([&](Time now) {
    return heartbeat.Advance(*node, now);
  });
  loop.Every(kConfigPeriod, [&](Time) {
    heartbeat.SendConfig();
  });
  NotifyServiceManager("READY=1");
  loop.Run(*node);
  NotifyServiceManager("STOPPING=1");
  node->Finish();
  return node->exit_code();
}

int ParseAndServe(const ProcessSpec& spec, int argc, char** argv) {
  SetLogName(spec.program);
  CLI::App app(spec.description, spec.program);
  app.option_defaults()->always_capture_default();
  app.failure_message(UsageMessage);
  BusOptions options;
  std::string name = spec.name;
  bool print_config = false;
  AddBusOptions(app, options);
  app.add_option("--name", name, "name in heartbeats and messages")
      ->check([](const std::string& text) {
        // Others know a process by its name as it stands in messages.
        return text.empty() || CleanLine(text, kMaxNameBytes) != text
                   ? "a name is 1 to 63 bytes of UTF-8 without control "
                     "characters"
                   : "";
      });
  app.set_config("--config", "", "TOML file with any of these options");
  ReadConfigAsToml(app);
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.add_flag("--print-config", print_config,
               "prints the effective options as TOML and exits")
      ->configurable(false);
  app.set_version_flag("--version", spec.program + " " + BuildId());
  if (spec.add_options) spec.add_options(app);
  TakeDecimalNumbersOnly(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  const Status completed = options.Complete();
  if (!completed) {
    LogError(completed.error().message);
    return kWrongUsage;
  }
  const std::string config = app.config_to_str(true, false);
  if (print_config) {
    std::cout << config;
    return 0;
  }
  SetLogName(name);
  try {
    return Serve(spec, name, options, config);
  } catch (const std::exception& error) {
    return Fail(error.what());
  }
}

}  // namespace

Status BusOptions::Complete() {
  lcm_url = EffectiveLcmUrl(lcm_url);
  if (advice_url.empty()) {
    Result<std::string> derived = AdviceUrlFor(lcm_url);
    if (!derived) return derived.error();
    advice_url = *std::move(derived);
  }
  const Result<LcmUrl> deployed = ParseLcmUrl(lcm_url);
  if (!deployed) return deployed.error();
  const Result<LcmUrl> advice = ParseLcmUrl(advice_url);
  if (!advice) return advice.error();
  lcm_url = deployed->text();
  advice_url = advice->text();
  if (!advice->is_udpm() && !OneBus()) {
    return Error{ErrorCode::kInvalid,
                 "--advice-url " + advice_url +
                     ": only a udpm:// bus can be apart from the deployed bus; "
                     "leave --advice-url out, and advice travels on " +
                     lcm_url};
  }
  return Done{};
}

bool BusOptions::OneBus() const {
  const Result<LcmUrl> deployed = ParseLcmUrl(lcm_url);
  const Result<LcmUrl> advice = ParseLcmUrl(advice_url);
  return deployed && advice && SameBus(*deployed, *advice);
}

Result<std::string> BusOptions::JournalUrl() const {
  if (OneBus()) return lcm_url;
  Result<std::string> journal = JournalUrlFor(lcm_url);
  if (!journal) return journal;
  const Result<LcmUrl> parsed = ParseLcmUrl(*journal);
  const Result<LcmUrl> advice = ParseLcmUrl(advice_url);
  if (parsed && advice && SameBus(*parsed, *advice)) {
    return Error{ErrorCode::kInvalid,
                 "--advice-url " + advice_url +
                     ": the port of --lcm-url plus two is for the gate's "
                     "journal; choose another port"};
  }
  return journal;
}

std::string BusOptions::Notice() const {
  if (lcm_url.starts_with("memq://")) {
    return lcm_url +
           " stays within this process: no other process is heard or hears it. "
           "For a set of processes use udpm:// or tcpq://";
  }
  if (lcm_url.starts_with("file://")) {
    return lcm_url +
           " is a log file: no other process is heard or hears this one. For a "
           "set of processes use udpm:// or tcpq://";
  }
  return {};
}

Result<ChannelNames> BusOptions::Channels() const {
  return ChannelNames::Create(robot, map_prefix);
}

void AddBusOptions(CLI::App& app, BusOptions& options) {
  app.add_option("--lcm-url", options.lcm_url,
                 "the deployed bus (default: LCM_DEFAULT_URL, else " +
                     std::string(kDefaultLcmUrl) + ")");
  app.add_option("--advice-url", options.advice_url,
                 "the advice bus (default: --lcm-url with its port plus one)");
  app.add_option("--robot", options.robot,
                 "puts NAME_ in front of every channel (A-Z, 0-9)");
  app.add_option("--map-prefix", options.map_prefix,
                 "does so for the map channels (default: the robot's)");
}

int RunProcess(const ProcessSpec& spec, int argc, char** argv) {
  ReserveStandardStreams();
  const int exit_code = ParseAndServe(spec, argc, argv);
  return FinishStandardOutput(spec.program.c_str(), exit_code);
}

}  // namespace terra::bus

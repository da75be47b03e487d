// terra-logger: the flight recorder.
// Listens to everything on the deployed bus, to advisors on the advice bus and
// to the gate's journal on its port;
// publishes MAP_REQUEST, STATUS, CONFIG; exits when asked to (SIGINT, SIGTERM),
// with 1 when anything was lost, or when it has no bus or no log folder.
#include <unistd.h>

#include <array>
#include <csignal>
#include <ctime>

#include <CLI/CLI.hpp>

#include "bus/build_id.h"
#include "bus/envelope.h"
#include "bus/process.h"
#include "logger/logger_node.h"

namespace {

constexpr std::int64_t kMegabyte = std::int64_t{1} << 20;

struct LoggerConfig {
  std::string folder = "log";
  std::int64_t part_mb = 256;
  std::int64_t quota_mb = 8192;
};

// What is worth knowing about a log besides its events.
std::string HeaderText(const terra::bus::ProcessContext& context) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  tzset();
  return "build " + std::string(terra::bus::BuildId()) + "\nhost " +
         host.data() + "\nlcm-url " + context.bus.lcm_url + "\nadvice-url " +
         context.bus.advice_url + "\nrobot " + context.bus.robot +
         "\ntime zone " + tzname[0];
}

terra::Result<std::unique_ptr<terra::bus::Node>> MakeNode(
    const LoggerConfig& config, terra::bus::ProcessContext& context) {
  terra::logger::RecorderOptions options;
  options.channels = context.channels;
  options.session = context.out.session();
  options.header = HeaderText(context);
  options.part_bytes = config.part_mb * kMegabyte;
  options.quota_bytes = config.quota_mb * kMegabyte;
  auto recorder = terra::logger::Recorder::Start(
      config.folder, std::move(options), terra::bus::UnixMicroseconds());
  if (!recorder) return recorder.error();
  auto node = std::make_unique<terra::logger::LoggerNode>(
      *std::move(recorder), context.channels, context.out);
  const terra::Result<std::string> journal = context.bus.JournalUrl();
  if (!journal) return journal.error();
  const terra::Status listening =
      node->Listen({context.bus.lcm_url, context.bus.advice_url, *journal});
  if (!listening) return listening.error();
  return std::unique_ptr<terra::bus::Node>(std::move(node));
}

}  // namespace

int main(int argc, char** argv) {
  // A file that may not grow is to be an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  LoggerConfig config;
  terra::bus::ProcessSpec spec;
  spec.program = "terra-logger";
  spec.name = "logger";
  spec.description =
      "Records everything on the bus into LCM event logs, each event on the "
      "disk within 100 ms.\nexample: terra-logger --out /var/log/terra "
      "--part-mb 64 --quota-mb 2048";
  spec.add_options = [&config](CLI::App& app) {
    app.add_option("--out", config.folder, "folder of the logs");
    app.add_option("--part-mb", config.part_mb,
                   "a new file begins after so many megabytes")
        ->check(CLI::Range(1, 1'000'000));
    app.add_option("--quota-mb", config.quota_mb,
                   "the oldest logs in the folder are deleted beyond so many "
                   "megabytes; 0 = never")
        ->check(CLI::Range(0, 1'000'000'000));
  };
  spec.make_node = [&config](terra::bus::ProcessContext& context) {
    return MakeNode(config, context);
  };
  return terra::bus::RunProcess(spec, argc, argv);
}

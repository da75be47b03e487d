// terra request: asks the running set for a route over LCM.
#include <chrono>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bus/advisor_channels.h"
#include "bus/bus.h"
#include "bus/codec.h"
#include "bus/event_loop.h"
#include "bus/log.h"
#include "bus/map_file_options.h"
#include "bus/number_range.h"
#include "bus/process.h"
#include "cli/commands.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "cli/request_node.h"
#include "cli/request_report.h"
#include "terrain/digest.h"
#include "terrain/files/picture.h"

namespace terra::cli {
namespace {

using terra_msg::deployed_t;

/// With --need-advice: the baseline is deployed, and nothing else came.
constexpr int kNoAdvice = 3;

struct RequestArguments {
  bus::BusOptions bus;
  Cell start;
  Cell goal;
  MapArguments map;
  double wait_s = 10;
  bool keep = false;
  bool need_advice = false;
  std::string picture;
  bool json = false;
};

// What the two routes cost, as the gate says.
std::string Caption(const deployed_t& deployed) {
  const std::string baseline = Printed("baseline %.1f", deployed.baseline_cost);
  if (deployed.mode != deployed_t::MODE_CANDIDATE) {
    return baseline + ", which is deployed";
  }
  return baseline +
         Printed(", deployed %.1f: %.1f %% less", deployed.deployed_cost,
                 SavingPercent(deployed.baseline_cost, deployed.deployed_cost));
}

Status Draw(const RequestNode& node, const RequestArguments& arguments) {
  if (node.map().map() == nullptr) {
    return Error{
        ErrorCode::kUnavailable,
        "no picture: the map did not arrive (" + node.map().state() + ")"};
  }
  PictureOptions picture;
  picture.starts = {arguments.start};
  picture.goals = {arguments.goal};
  if (node.baseline() && node.baseline()->num_waypoints > 0) {
    picture.routes.push_back(PictureRoute{bus::WaypointsOf(*node.baseline()),
                                          kBaselineColor, "baseline"});
  }
  if (node.HasRoute() && node.deployed()->mode == deployed_t::MODE_CANDIDATE) {
    picture.routes.push_back(PictureRoute{bus::WaypointsOf(*node.deployed()),
                                          kCandidateColor, "deployed"});
  }
  if (node.HasRoute()) picture.caption = Caption(*node.deployed());
  return WritePicture(node.map().map()->map, picture, arguments.picture);
}

int FailRequest(const std::string& message, int exit_code = kCouldNot) {
  std::cerr << "terra request: " << message << "\n";
  return exit_code;
}

int Ask(RequestArguments& arguments) {
  const Status completed = arguments.bus.Complete();
  if (!completed) return FailRequest(completed.error().message, kWrongUsage);
  bus::SetLogName("terra");
  if (const std::string notice = arguments.bus.Notice(); !notice.empty()) {
    bus::LogWarning(notice);
  }
  RequestPlan plan;
  plan.request_id = bus::RandomId();
  plan.start = arguments.start;
  plan.goal = arguments.goal;
  plan.keep = arguments.keep;
  plan.want_map = !arguments.picture.empty();
  plan.wait = std::chrono::duration_cast<bus::Duration>(
      std::chrono::duration<double>(arguments.wait_s));
  if (!arguments.map.path.empty()) {
    const Result<MapFile> map =
        ReadMap(arguments.map.path, arguments.map.options);
    if (!map) return FailRequest(map.error().message);
    SayNotices(*map);
    plan.map_id = MapId(map->map);
  }
  const bus::StopSignal stop;
  const Result<bus::ChannelNames> channels = arguments.bus.Channels();
  if (!channels) return FailRequest(channels.error().message, kWrongUsage);
  bus::Inbox inbox;
  Result<std::unique_ptr<bus::Bus>> opened =
      bus::Bus::Open(arguments.bus.lcm_url, *channels);
  if (!opened) return FailRequest(opened.error().message);
  const std::unique_ptr<bus::Bus> bus = *std::move(opened);
  bus::Outbox out(*bus, bus::RandomId());
  RequestNode node(plan, out);
  const Status listening = bus->Listen(node.channels(), inbox);
  if (!listening) return FailRequest(listening.error().message);
  bus::EventLoop loop(inbox, stop);
  // A route comes without advisors too.
  const Status advisors =
      bus::ListenToAdvisors(arguments.bus, *channels, node, loop);
  if (!advisors) bus::LogWarning(advisors.error().message);
  loop.Run(node);

  if (arguments.json) {
    std::cout << RequestJson(node).dump(
                     -1, ' ', false, nlohmann::json::error_handler_t::replace)
              << "\n";
  }
  if (!node.HasRoute()) return FailRequest(WhyNoRoute(node));
  if (!arguments.json) PrintRequest(node);
  if (!arguments.picture.empty()) {
    const Status drawn = Draw(node, arguments);
    if (!drawn) return FailRequest(drawn.error().message);
  }
  if (arguments.need_advice && !node.advised()) {
    return FailRequest("no advice came; the baseline is deployed", kNoAdvice);
  }
  return kDone;
}

}  // namespace

void AddRequestCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "request", "Asks the running processes for a route over LCM");
  const auto arguments = std::make_shared<RequestArguments>();
  bus::AddBusOptions(*command, arguments->bus);
  AddCellOption(*command, "--start", arguments->start, "start cell X,Y");
  AddCellOption(*command, "--goal", arguments->goal, "goal cell X,Y");
  command->add_option("--map", arguments->map.path,
                      "only compared with the map in force");
  command->add_option("--legend", arguments->map.options.legend,
                      "legend of --map");
  bus::AddUnknownOption(*command, arguments->map.options.unknown);
  AddCostModelOptions(*command, arguments->map.options.cost_model);
  command
      ->add_option("--wait", arguments->wait_s,
                   "seconds to wait for a refined route, or for another map "
                   "where the planner finds no route on the one it has "
                   "(default 10); a baseline is waited for at least 2 s")
      ->check(bus::InRange(0.0, 86'400.0));
  command
      ->add_flag("--keep", arguments->keep,
                 "go on asking until stopped (Ctrl-C), whatever map comes")
      ->excludes("--map");
  command->add_flag("--need-advice", arguments->need_advice,
                    "exit with 3 where the baseline is deployed and no advice "
                    "on it came");
  command->add_option("--picture", arguments->picture,
                      "writes a PNG of map and routes");
  command->add_flag("--json", arguments->json, "prints JSON");
  command->footer(
      "example: terra request --start 30,250 --goal 470,250 --picture r.png");
  command->callback([arguments, &exit_code] {
    exit_code = Ask(*arguments);
  });
}

}  // namespace terra::cli

// terra request: asks the running set for a route over LCM.
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bus/bus.h"
#include "bus/codec.h"
#include "bus/envelope.h"
#include "bus/event_loop.h"
#include "bus/number_range.h"
#include "bus/process.h"
#include "cli/commands.h"
#include "cli/map_arguments.h"
#include "cli/output.h"
#include "cli/request_node.h"
#include "terrain/digest.h"
#include "terrain/files/picture.h"
#include "verifier/verify.h"

namespace terra::cli {
namespace {

using terra_msg::baseline_t;
using terra_msg::deployed_t;

struct RequestArguments {
  bus::BusOptions bus;
  Cell start;
  Cell goal;
  MapArguments map;
  double wait_s = 10;
  bool keep = false;
  std::string picture;
  bool json = false;
};

std::string_view BaselineStatus(std::int8_t status) {
  switch (status) {
    case baseline_t::STATUS_OK:
      return "ok";
    case baseline_t::STATUS_NO_ROUTE:
      return "no route on the planner's graph";
    case baseline_t::STATUS_START_OUTSIDE:
      return "the start lies outside the map";
    case baseline_t::STATUS_GOAL_OUTSIDE:
      return "the goal lies outside the map";
    case baseline_t::STATUS_START_BLOCKED:
      return "the start lies on a blocked cell";
    case baseline_t::STATUS_GOAL_BLOCKED:
      return "the goal lies on a blocked cell";
    case baseline_t::STATUS_OTHER_MAP:
      return "the planner has another map in force";
    case baseline_t::STATUS_TOO_LONG:
      return "the route is too long for the bus (2,048 waypoints, 80,000 "
             "steps)";
    case baseline_t::STATUS_NO_MAP:
      return "the planner has no map; is terra-map running?";
    case baseline_t::STATUS_CANCELLED:
      return "the request was cancelled";
    default:
      return "unknown status";
  }
}

std::string CodeText(const terra_msg::verdict_t& verdict) {
  return std::string(
      verifier::CodeName(static_cast<verifier::Code>(verdict.code)));
}

nlohmann::json Number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json Milliseconds(const RequestNode::Latency& latency) {
  return latency ? nlohmann::json(*latency) : nlohmann::json();
}

nlohmann::json ToJson(const RequestNode& node) {
  nlohmann::json result;
  const auto& baseline = node.baseline();
  const auto& deployed = node.deployed();
  result["request_id"] = baseline ? baseline->request_id : 0;
  result["map_id"] = deployed ? deployed->map_id : 0;
  result["baseline_status"] =
      baseline ? BaselineStatus(baseline->status) : "no answer";
  result["baseline_cost"] =
      deployed ? Number(deployed->baseline_cost) : nlohmann::json();
  result["deployed_cost"] =
      deployed ? Number(deployed->deployed_cost) : nlohmann::json();
  result["deployed"] = !node.HasRoute() ? "none"
                       : deployed->mode == deployed_t::MODE_CANDIDATE
                           ? "candidate"
                           : "baseline";
  result["source"] = deployed ? deployed->source : "";
  result["baseline_ms"] = Milliseconds(node.baseline_ms());
  result["deployed_ms"] = Milliseconds(node.deployed_ms());
  result["refined_ms"] = Milliseconds(node.refined_ms());
  result["waypoints"] = nlohmann::json::array();
  if (deployed) {
    for (const Cell& cell : bus::WaypointsOf(*deployed)) {
      result["waypoints"].push_back({cell.x, cell.y});
    }
  }
  result["verdicts"] = nlohmann::json::array();
  for (const terra_msg::verdict_t& verdict : node.verdicts()) {
    result["verdicts"].push_back(
        {{"advisor", verdict.advisor},
         {"code", CodeText(verdict)},
         {"candidate_cost", Number(verdict.candidate_cost)},
         {"cost_to_beat", Number(verdict.cost_to_beat)}});
  }
  result["advisors"] = nlohmann::json::array();
  for (const auto& advisor : node.advisors().advisors()) {
    result["advisors"].push_back({{"name", advisor.name},
                                  {"state", advisor.state},
                                  {"last_error", advisor.error}});
  }
  return result;
}

void PrintWhyNone(const RequestNode& node) {
  const auto advisors = node.advisors().advisors();
  std::printf("verdict    none: %s\n",
              advisors.empty()              ? "no advisor was heard on this bus"
              : node.advisors().AllGaveUp() ? "no advisor had an answer"
                                            : "no advisor answered in time");
  for (const auto& advisor : advisors) {
    std::printf("advisor    %s: %s%s%s\n", advisor.name.c_str(),
                advisor.state.c_str(), advisor.error.empty() ? "" : "; ",
                advisor.error.c_str());
  }
}

void PrintText(const RequestNode& node) {
  const deployed_t& deployed = *node.deployed();
  std::printf("baseline   %10.3f   %s, %.2f ms after the request\n",
              deployed.baseline_cost, node.baseline()->planner.c_str(),
              node.baseline_ms().value_or(0));
  std::printf(
      "deployed   %10.3f   %s%s\n", deployed.deployed_cost,
      deployed.source.c_str(),
      deployed.mode == deployed_t::MODE_CANDIDATE ? "'s route" : "'s baseline");
  std::printf("saving     %10.3f   %.2f %%\n",
              deployed.baseline_cost - deployed.deployed_cost,
              SavingPercent(deployed.baseline_cost, deployed.deployed_cost));
  std::printf("latency    baseline deployed after %.2f ms",
              node.deployed_ms().value_or(0));
  if (node.refined_ms()) {
    std::printf(", refined route after %.2f ms\n", *node.refined_ms());
  } else {
    std::printf(", no refined route\n");
  }
  for (const terra_msg::verdict_t& verdict : node.verdicts()) {
    std::printf("verdict    %s on %s, attempt %lld\n",
                CodeText(verdict).c_str(), verdict.advisor.c_str(),
                static_cast<long long>(verdict.attempt));
  }
  if (node.verdicts().empty()) PrintWhyNone(node);
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
  return WritePicture(node.map().map()->map, picture, arguments.picture);
}

int FailRequest(const std::string& message, int exit_code = kCouldNot) {
  std::cerr << "terra request: " << message << "\n";
  return exit_code;
}

// Why there is no route, in a sentence.
std::string Explain(const RequestNode& node) {
  if (!node.baseline()) {
    return "no planner answered; is terra-planner running on this bus?";
  }
  if (node.baseline()->status != baseline_t::STATUS_OK) {
    return std::string(BaselineStatus(node.baseline()->status));
  }
  if (!node.deployed()) {
    return "the gate did not answer; is terra-verifier running on this bus?";
  }
  for (const terra_msg::verdict_t& verdict : node.verdicts()) {
    if (verdict.subject == terra_msg::verdict_t::SUBJECT_BASELINE) {
      return "the gate refused the baseline: " + CodeText(verdict) +
             " at segment " + std::to_string(verdict.fail_segment) + ", cell " +
             ToString(Cell{verdict.fail_x, verdict.fail_y});
    }
  }
  return "nothing was deployed in time";
}

int Ask(RequestArguments& arguments) {
  const Status completed = arguments.bus.Complete();
  if (!completed) return FailRequest(completed.error().message, kWrongUsage);
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
  loop.Run(node);

  if (arguments.json) {
    std::cout << ToJson(node).dump(-1, ' ', false,
                                   nlohmann::json::error_handler_t::replace)
              << "\n";
  }
  if (!node.HasRoute()) return FailRequest(Explain(node));
  if (!arguments.json) PrintText(node);
  if (!arguments.picture.empty()) {
    const Status drawn = Draw(node, arguments);
    if (!drawn) return FailRequest(drawn.error().message);
  }
  return 0;
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
  AddCostModelOptions(*command, arguments->map.options.cost_model);
  command
      ->add_option("--wait", arguments->wait_s,
                   "seconds to wait for a refined route (default 10)")
      ->check(bus::InRange(0.0, 86'400.0));
  command->add_flag("--keep", arguments->keep,
                    "go on asking until stopped (Ctrl-C)");
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

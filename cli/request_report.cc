#include "cli/request_report.h"

#include <cmath>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "bus/codec.h"
#include "cli/output.h"
#include "verifier/verify.h"

namespace terra::cli {
namespace {

using terra_msg::baseline_t;
using terra_msg::deployed_t;

// Names come from the bus.
constexpr std::size_t kShownName = 63;

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

// Says so where a process has another map than the one that is offered.
std::string OfOtherMap(const std::string& who, std::int64_t map_id,
                       const RequestNode& node) {
  const std::int64_t offered = node.offered_map_id();
  if (offered == map_id) return "";
  if (offered == 0) return "; no map was heard, is terra-map running?";
  return "; terra-map offers map " + std::to_string(offered) + ", which " +
         who + " did not get in time: terra monitor shows its state";
}

}  // namespace

nlohmann::json RequestJson(const RequestNode& node) {
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

void PrintRequest(const RequestNode& node) {
  const deployed_t& deployed = *node.deployed();
  if (node.baseline()) {
    std::printf("baseline   %10.3f   %s, %.2f ms after the request\n",
                deployed.baseline_cost,
                Printable(node.baseline()->planner, kShownName).c_str(),
                node.baseline_ms().value_or(0));
  } else {
    std::printf("baseline   %10.3f   heard by the gate alone\n",
                deployed.baseline_cost);
  }
  std::printf(
      "deployed   %10.3f   %s%s\n", deployed.deployed_cost,
      Printable(deployed.source, kShownName).c_str(),
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
    const std::string reason =
        verdict.code == terra_msg::verdict_t::CODE_PARSE_ERROR
            ? node.advisors().ErrorOf(verdict.advisor)
            : "";
    std::printf("verdict    %s on %s, attempt %lld%s%s\n",
                CodeText(verdict).c_str(),
                Printable(verdict.advisor, kShownName).c_str(),
                static_cast<long long>(verdict.attempt),
                reason.empty() ? "" : "; ", reason.c_str());
  }
  if (node.verdicts().empty()) PrintWhyNone(node);
}

std::string WhyNoRoute(const RequestNode& node) {
  if (!node.baseline()) {
    return "no planner answered; is terra-planner running on this bus?";
  }
  if (node.baseline()->status != baseline_t::STATUS_OK) {
    return std::string(BaselineStatus(node.baseline()->status)) +
           OfOtherMap("the planner", node.baseline()->map_id, node);
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
  return "nothing was deployed in time" +
         OfOtherMap("the gate", node.deployed()->map_id, node);
}

}  // namespace terra::cli

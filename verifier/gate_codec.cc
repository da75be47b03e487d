#include "verifier/gate_codec.h"

#include <cmath>
#include <limits>

#include "bus/codec.h"
#include "terrain/segment.h"

namespace terra::verifier {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;
using terra_msg::deployed_t;
using terra_msg::plan_request_t;
using terra_msg::pose_t;
using terra_msg::verdict_t;

static_assert(kMaxNameBytes == bus::kMaxNameBytes);
static_assert(kBusLimits.max_waypoints == bus::kMaxWaypoints);
static_assert(kBusLimits.max_steps == bus::kMaxSteps);

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

double CostOnBus(double cost) {
  return std::isfinite(cost) ? cost : kNotANumber;
}

double CostFromBus(double cost) {
  return std::isfinite(cost) ? cost : kImpassable;
}

}  // namespace

RequestEvent ToEvent(const plan_request_t& message) {
  RequestEvent event;
  event.request_id = message.request_id;
  event.cancel = message.action == plan_request_t::ACTION_CANCEL;
  event.start = Cell{message.start_x, message.start_y};
  event.goal = Cell{message.goal_x, message.goal_y};
  return event;
}

BaselineEvent ToEvent(const baseline_t& message) {
  BaselineEvent event;
  event.session = message.session;
  event.planner = message.planner;
  event.request_id = message.request_id;
  event.start = Cell{message.start_x, message.start_y};
  event.goal = Cell{message.goal_x, message.goal_y};
  event.map_id = message.map_id;
  event.cancelled = message.status == baseline_t::STATUS_CANCELLED;
  event.has_route = message.status == baseline_t::STATUS_OK;
  event.baseline_digest = message.baseline_digest;
  event.waypoints = bus::WaypointsOf(message);
  return event;
}

AdviceEvent ToEvent(const advice_t& message) {
  AdviceEvent event;
  event.session = message.session;
  event.advisor = message.advisor;
  event.attempt = message.attempt;
  event.candidate = message.candidate;
  event.request_id = message.request_id;
  event.map_id = message.map_id;
  event.baseline_digest = message.baseline_digest;
  event.anchor =
      Anchor{message.anchor_session, message.anchor_route_seq,
             message.anchor_index, Cell{message.anchor_x, message.anchor_y}};
  event.kind = AdviceKind{message.kind};  // any byte: the gate looks at it
  event.waypoints = bus::WaypointsOf(message);
  return event;
}

PoseEvent ToEvent(const pose_t& message) {
  PoseEvent event;
  event.cell = Cell{message.pose_x, message.pose_y};
  event.session = message.deployed_session;
  event.route_seq = message.deployed_route_seq;
  return event;
}

verdict_t ToMessage(const Verdict& verdict, std::int64_t t_det_us) {
  verdict_t message{};
  message.decision = verdict.decision;
  message.subject = static_cast<std::int8_t>(verdict.subject);
  message.request_id = verdict.request_id;
  message.map_id = verdict.map_id;
  message.baseline_digest = verdict.baseline_digest;
  message.anchor_session = verdict.anchor.session;
  message.anchor_route_seq = verdict.anchor.route_seq;
  message.anchor_index = verdict.anchor.index;
  message.anchor_x = verdict.anchor.cell.x;
  message.anchor_y = verdict.anchor.cell.y;
  message.advisor = bus::CleanText(verdict.advisor, kMaxNameBytes);
  message.advisor_session = verdict.advisor_session;
  message.attempt = verdict.attempt;
  message.candidate = verdict.candidate;
  message.code = static_cast<std::int16_t>(verdict.code);
  message.candidate_cost = CostOnBus(verdict.candidate_cost);
  message.baseline_cost = CostOnBus(verdict.baseline_cost);
  message.cost_to_beat = CostOnBus(verdict.cost_to_beat);
  message.route_seq_before = verdict.route_seq_before;
  message.fail_segment = verdict.fail_segment;
  message.fail_x = verdict.fail_cell.x;
  message.fail_y = verdict.fail_cell.y;
  message.t_det_us = t_det_us;
  return message;
}

deployed_t ToMessage(const Deployed& deployed) {
  deployed_t message{};
  message.decision = deployed.decision;
  message.route_seq = deployed.route_seq;
  message.request_id = deployed.request_id;
  message.start_x = deployed.start.x;
  message.start_y = deployed.start.y;
  message.goal_x = deployed.goal.x;
  message.goal_y = deployed.goal.y;
  message.map_id = deployed.map_id;
  message.baseline_digest = deployed.baseline_digest;
  message.mode = static_cast<std::int8_t>(deployed.mode);
  message.cause = static_cast<std::int8_t>(deployed.cause);
  message.source = deployed.source;
  message.source_session = deployed.source_session;
  message.source_attempt = deployed.source_attempt;
  message.source_candidate = deployed.source_candidate;
  bus::SetWaypoints(message, deployed.waypoints);
  if (deployed.has_route()) {
    const bus::Chain chain =
        bus::EncodeChain(RasterizeRoute(deployed.waypoints));
    message.num_steps = chain.num_steps;
    message.num_chain_bytes = static_cast<std::int32_t>(chain.bytes.size());
    message.chain = chain.bytes;
  }
  message.deployed_cost = CostOnBus(deployed.cost);
  message.baseline_cost = CostOnBus(deployed.baseline_cost);
  return message;
}

Deployed ToDeployed(const deployed_t& message) {
  Deployed deployed;
  deployed.decision = message.decision;
  deployed.route_seq = message.route_seq;
  deployed.request_id = message.request_id;
  deployed.start = Cell{message.start_x, message.start_y};
  deployed.goal = Cell{message.goal_x, message.goal_y};
  deployed.map_id = message.map_id;
  deployed.baseline_digest = message.baseline_digest;
  deployed.mode = Mode{message.mode};
  deployed.cause = Cause{message.cause};
  deployed.source = message.source;
  deployed.source_session = message.source_session;
  deployed.source_attempt = message.source_attempt;
  deployed.source_candidate = message.source_candidate;
  deployed.waypoints = bus::WaypointsOf(message);
  deployed.cost = CostFromBus(message.deployed_cost);
  deployed.baseline_cost = CostFromBus(message.baseline_cost);
  return deployed;
}

}  // namespace terra::verifier

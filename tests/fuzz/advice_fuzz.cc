// A datagram of the advice bus, all the way through the gate: whatever it says,
// what is deployed is feasible, costs what is said and no more than the
// baseline. Half of what decodes is given the right key, so that it gets far.

#include <memory>

#include "bus/advice_receiver.h"
#include "bus/codec.h"
#include "bus/messages.h"
#include "terrain/digest.h"
#include "terrain/route_cost.h"
#include "tests/fuzz/fuzz.h"
#include "verifier/gate.h"

namespace {

using terra::Cell;
using terra::Route;
using namespace terra::verifier;

constexpr Cell kStart = {1, 1};
constexpr Cell kGoal = {14, 9};
constexpr GateOptions kOptions = {.margin = 0, .session = 4711};

// Dear ground with cheap rows and a few obstacles.
const terra::TerrainMap& Map() {
  static const terra::TerrainMap map = [] {
    terra::Legend legend =
        terra::Legend::Create({{0, "obstacle", terra::kImpassable, {0, 0, 0}},
                               {1, "cheap", 1, {1, 0, 0}},
                               {2, "dear", 3.5, {2, 0, 0}}})
            .value();
    terra::ByteRaster ids = terra::ByteRaster::Constant(12, 16, 2);
    ids.row(0).setConstant(1);
    ids.row(9).setConstant(1);
    ids.block(3, 5, 3, 2).setConstant(0);
    return terra::TerrainMap::Create(std::move(ids), std::move(legend)).value();
  }();
  return map;
}

AdviceEvent ToEvent(const terra_msg::advice_t& message) {
  AdviceEvent event;
  event.session = message.session;
  event.advisor = message.advisor;
  event.attempt = message.attempt;
  event.candidate = message.candidate;
  event.request_id = message.request_id;
  event.map_id = message.map_id;
  event.baseline_digest = message.baseline_digest;
  event.anchor = {message.anchor_session,
                  message.anchor_route_seq,
                  message.anchor_index,
                  {message.anchor_x, message.anchor_y}};
  event.kind = static_cast<AdviceKind>(message.kind);
  event.waypoints = terra::bus::WaypointsOf(message);
  return event;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto datagram = terra::bus::ParseLcmDatagram({data, size});
  if (!datagram) return 0;
  const auto message =
      terra::bus::Decode<terra_msg::advice_t>(datagram->payload);
  if (!message) return 0;

  Gate gate(kOptions);
  const std::int64_t map_id = terra::MapId(Map());
  gate.On(MapEvent{{std::shared_ptr<void>(), &Map()}, map_id});
  gate.On(RequestEvent{1, false, kStart, kGoal});
  BaselineEvent baseline;
  baseline.session = 5;
  baseline.request_id = 1;
  baseline.start = kStart;
  baseline.goal = kGoal;
  baseline.map_id = map_id;
  baseline.has_route = true;
  baseline.waypoints = {kStart, {1, 8}, kGoal};
  baseline.baseline_digest =
      terra::BaselineDigest(1, map_id, baseline.waypoints);
  gate.On(baseline);
  const double baseline_cost = gate.deployed().cost;

  AdviceEvent event = ToEvent(*message);
  if (message->utime % 2 != 0) {
    event.request_id = 1;
    event.map_id = map_id;
    event.baseline_digest = baseline.baseline_digest;
    event.anchor.session = kOptions.session;
    event.anchor.route_seq = gate.deployed().route_seq;
  }
  gate.On(event);
  const Deployed& deployed = gate.deployed();
  const terra::RouteWalk walk = terra::WalkRoute(Map(), deployed.waypoints);
  terra::fuzz::Require(
      walk.feasible() && deployed.waypoints.front() == kStart &&
          deployed.waypoints.back() == kGoal && walk.cost == deployed.cost,
      "the deployed route is feasible and costs what is said");
  terra::fuzz::Require(deployed.cost <= baseline_cost,
                       "nothing dearer than the baseline is deployed");
  return 0;
}

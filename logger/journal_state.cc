#include "logger/journal_state.h"

#include <utility>

#include "verifier/gate_codec.h"
#include "verifier/gate_core.h"
#include "verifier/verify.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::gate_step_t;
using verifier::GateState;

Error Missing(const std::string& what) {
  return Error{ErrorCode::kNotFound, "the log does not hold " + what};
}

// The request in force is the one that DEPLOYED names: none comes into force
// without one.
Status AddDeployed(const gate_step_t& step, const LogContents& contents,
                   GateState& state) {
  if (step.route_seq == 0) return Done{};
  const deployed_t* deployed = contents.FindRoute(step.session, step.route_seq);
  if (deployed == nullptr) {
    return Missing("DEPLOYED of route " + std::to_string(step.route_seq));
  }
  state.deployed = verifier::ToDeployed(*deployed);
  state.request.request_id = step.request_id;
  state.request.cancelled = step.request_cancelled != 0;
  state.request.start = state.deployed.start;
  state.request.goal = state.deployed.goal;
  return Done{};
}

Status AddMap(const gate_step_t& step, LogContents& contents,
              GateState& state) {
  if (step.map_id == 0) return Done{};
  const bus::MapPtr map = contents.maps.Find(step.map_id);
  if (!map) return Missing("map " + std::to_string(step.map_id));
  state.map = std::shared_ptr<const TerrainMap>(map, &map->map);
  state.map_id = step.map_id;
  return Done{};
}

Status AddBaseline(const gate_step_t& step, const LogContents& contents,
                   GateState& state) {
  if (step.baseline_digest == 0) return Done{};
  const auto* baseline =
      contents.FindBaseline(step.baseline_digest, step.baseline_session);
  if (baseline == nullptr) {
    return Missing("BASELINE " + std::to_string(step.baseline_digest));
  }
  state.baseline = verifier::ToEvent(baseline->message);
  // Another planner may have found the same route.
  state.baseline->session = step.baseline_session;
  return Done{};
}

}  // namespace

Result<verifier::Gate> GateBefore(const gate_step_t& step,
                                  const verifier::GateOptions& options,
                                  LogContents& contents) {
  GateState state;
  state.answered_by = step.answered_by;
  state.place = step.place_index;
  state.on_route = step.place_on_route != 0;
  state.decisions = step.decision;
  for (const Status& added :
       {AddDeployed(step, contents, state), AddMap(step, contents, state),
        AddBaseline(step, contents, state)}) {
    if (!added) return added.error();
  }
  std::optional<verifier::Gate> gate = verifier::Gate::GoOnFrom(options, state);
  if (!gate || verifier::CoreDigest(*gate) != step.core_before) {
    return Error{ErrorCode::kInvalid,
                 "what the log holds is not the core that the step names"};
  }
  return *std::move(gate);
}

std::optional<std::string> WrongPrice(const verifier::Deployed& deployed,
                                      LogContents& contents) {
  if (!deployed.has_route()) return std::nullopt;
  const bus::MapPtr map = contents.maps.Find(deployed.map_id);
  if (!map) return std::nullopt;
  const double cost =
      verifier::CheckRoute(map->map, deployed.waypoints, deployed.start,
                           deployed.goal, verifier::kBusLimits)
          .cost;
  if (cost == deployed.cost && deployed.cost <= deployed.baseline_cost) {
    return std::nullopt;
  }
  return "the deployed route costs " + std::to_string(cost) +
         " on its map; the log says " + std::to_string(deployed.cost) +
         " against " + std::to_string(deployed.baseline_cost);
}

}  // namespace terra::logger

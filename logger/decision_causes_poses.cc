#include <algorithm>
#include <map>

#include "logger/decision_causes.h"
#include "verifier/gate_codec.h"

// Which poses the gate had heard no decision says.

namespace terra::logger {
namespace {

// The last route before a decision that is known to be another request's.
std::int64_t LastRouteOfOthers(
    std::int64_t request_id, std::int64_t decision,
    const std::map<std::int64_t, Logged<LogContents::Decided>>& decisions) {
  std::int64_t last = 0;
  for (const auto& [number, logged] : decisions) {
    if (number >= decision) break;
    const auto* deployed = std::get_if<terra_msg::deployed_t>(&logged.message);
    if (deployed != nullptr && deployed->request_id != request_id) {
      last = std::max(last, deployed->route_seq);
    }
  }
  return last;
}

}  // namespace

// The next poses that are logged before the decision, until one is enough.
template <typename Enough>
GateEvents DecisionCauses::PosesUntil(const Enough& enough) const {
  GateEvents heard;
  const auto found = contents_.poses.find(session_);
  if (found == contents_.poses.end()) return heard;
  const std::int64_t others =
      LastRouteOfOthers(gate_->deployed().request_id, decision_,
                        contents_.decisions.at(session_));
  for (std::size_t i = gate_->poses_heard(); i < found->second.size(); ++i) {
    const Logged<terra_msg::pose_t>& said = found->second[i];
    if (said.index >= index_) break;
    verifier::PoseEvent event = verifier::ToEvent(said.message);
    event.route_seq = Difference(event.route_seq, route_seq_offset_);
    // From before the state that the audit began with: the robot's place may
    // have come from a route before, but not from another request's.
    if (said.index < began_at_ && said.message.deployed_route_seq > others) {
      event.route_seq = gate_->deployed().route_seq;
    }
    heard.emplace_back(event);
    if (enough(event)) break;
  }
  return heard;
}

// A pose is evidence where a verdict needs one, so no more are heard than make
// it right.
DecisionCauses::Step DecisionCauses::PosesFor(
    const terra_msg::verdict_t& verdict, Ways& ways) const {
  const bool late = verdict.code == terra_msg::verdict_t::CODE_LATE;
  DrivenRoute driven = gate_->driven();
  GateEvents heard = PosesUntil([&](const verifier::PoseEvent& pose) {
    if (pose.route_seq == gate_->deployed().route_seq) driven.OnPose(pose.cell);
    return driven.Passed(verdict.anchor_index) == late;
  });
  if (driven.Passed(verdict.anchor_index) == late) return heard;
  if (late) ways.missing = "the log does not hold a POSE that shows it late";
  return std::nullopt;
}

GateEvents DecisionCauses::AllPoses() const {
  return PosesUntil([](const verifier::PoseEvent&) {
    return false;
  });
}

}  // namespace terra::logger

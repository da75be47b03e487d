#pragma once

#include <cstdint>

#include "bus/messages.h"
#include "verifier/gate_messages.h"

/// The gate's events and decisions as messages. Apart from the node, so that
/// the audit of a log makes the same messages from the same decisions.
namespace terra::verifier {

RequestEvent ToEvent(const terra_msg::plan_request_t& message);
BaselineEvent ToEvent(const terra_msg::baseline_t& message);
AdviceEvent ToEvent(const terra_msg::advice_t& message);
PoseEvent ToEvent(const terra_msg::pose_t& message);

/// Costs that are infinite here are not a number there. The envelope (utime,
/// session, seq) is the sender's business.
terra_msg::verdict_t ToMessage(const Verdict& verdict, std::int64_t t_det_us);
terra_msg::deployed_t ToMessage(const Deployed& deployed);

/// What such a message says was deployed.
Deployed ToDeployed(const terra_msg::deployed_t& message);

}  // namespace terra::verifier

#pragma once

#include "bus/message_schema.h"
#include "bus/wire.h"

/// Every message type with its channel, layout and limits, all from lcmtypes/;
/// tests/bus/golden holds one encoded message of each.
///
/// What the gate says is bounded there: names (kMaxNameBytes), waypoints,
/// steps. What others say to the gate, BASELINE and ADVICE, is bounded by its
/// bytes alone: where it is more than the gate takes, the gate says so in a
/// VERDICT, which it could not do for a message that does not decode.
namespace terra::bus {

static_assert(MessageTraits<terra_msg::deployed_t>::kMaxNumWaypoints ==
              kMaxWaypoints);
static_assert(MessageTraits<terra_msg::deployed_t>::kMaxNumChainBytes ==
              kMaxSteps / 2);
static_assert(MessageTraits<terra_msg::deployed_t>::kMaxSource ==
              kMaxNameBytes);
static_assert(MessageTraits<terra_msg::verdict_t>::kMaxAdvisor ==
              kMaxNameBytes);

}  // namespace terra::bus

#pragma once

#include "terra_msg/advice_t.hpp"
#include "terra_msg/baseline_t.hpp"
#include "terra_msg/config_t.hpp"
#include "terra_msg/deployed_t.hpp"
#include "terra_msg/gate_step_t.hpp"
#include "terra_msg/log_mark_t.hpp"
#include "terra_msg/map_header_t.hpp"
#include "terra_msg/map_request_t.hpp"
#include "terra_msg/map_tile_t.hpp"
#include "terra_msg/plan_request_t.hpp"
#include "terra_msg/pose_t.hpp"
#include "terra_msg/status_t.hpp"
#include "terra_msg/verdict_t.hpp"

#include "bus/wire.h"

/// The channel and layout of every message type, field by field as in
/// lcmtypes/; tests/bus/golden holds one encoded message of each.
///
/// What the gate says is bounded here: names (kMaxNameBytes), waypoints, steps.
/// What others say to the gate, BASELINE and ADVICE, is bounded by its bytes
/// alone: where it is more than the gate takes, the gate says so in a VERDICT,
/// which it could not do for a message that does not decode.
namespace terra::bus {

// Declares the traits of one type.
#define TERRA_MESSAGE(type, channel, layout)              \
  template <>                                             \
  struct MessageTraits<terra_msg::type> {                 \
    static constexpr Channel kChannel = Channel::channel; \
    static constexpr std::string_view kLayout = layout;   \
  };

TERRA_MESSAGE(map_header_t, kMapHeader,
              "lll ll ii dddd N256 h*d*i*s* b i i N4096 l*")
TERRA_MESSAGE(map_tile_t, kMapTile, "lll N1024 i*l*i* N20000 b*")
TERRA_MESSAGE(map_request_t, kMapRequest, "lll l N4096 i*")
TERRA_MESSAGE(plan_request_t, kPlanRequest, "lll l b l iiii")
TERRA_MESSAGE(baseline_t, kBaseline, "lll l iiii l s b l N i*i* d lll")
TERRA_MESSAGE(advice_t, kAdvice,
              "lll lll ll iii ssss l i l bbb N i*i* ss ll d ll s")
TERRA_MESSAGE(verdict_t, kVerdict, "lll l b lll ll iii s63 ll i h ddd l iii l")
TERRA_MESSAGE(deployed_t, kDeployed,
              "lll ll l iiii ll bb s63 ll i N2048 i*i* i N40000 b* dd")
TERRA_MESSAGE(pose_t, kPose, "lll ii dd ll")
TERRA_MESSAGE(status_t, kStatus, "lll ss i ss N s*l* s")
TERRA_MESSAGE(config_t, kConfig, "lll sss")
TERRA_MESSAGE(log_mark_t, kLog, "lll b ii lll l s")
TERRA_MESSAGE(gate_step_t, kGateStep,
              "lll ll bb lll lblllll iiibdl l ll i ll l N59000 b*")

#undef TERRA_MESSAGE

}  // namespace terra::bus

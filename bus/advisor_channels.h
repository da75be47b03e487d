#pragma once

#include <array>

#include "bus/channels.h"
#include "bus/event_loop.h"
#include "bus/node.h"
#include "bus/process.h"
#include "terrain/result.h"

namespace terra::bus {

/// What advisors say on the advice bus besides ADVICE.
inline constexpr std::array kAdvisorChannels = {
    Channel::kMapRequest, Channel::kStatus, Channel::kConfig};

/// Hands to a node, in the turns of a loop, what advisors say on the advice bus
/// on those of kAdvisorChannels that the node hears: each channel within the
/// limits of an AdviceReceiver of its own. Where both URLs name one bus, that
/// is heard already. The node must outlive the loop's Run.
///
/// Errors: an advice bus that cannot be heard.
Status ListenToAdvisors(const BusOptions& options, const ChannelNames& names,
                        Node& node, EventLoop& loop);

}  // namespace terra::bus

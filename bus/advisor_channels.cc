#include "bus/advisor_channels.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bus/advice_receiver.h"

namespace terra::bus {
namespace {

// Of the advice bus, in one turn of a loop.
constexpr std::size_t kAdvisorDatagramsPerTurn = 64;

}  // namespace

Status ListenToAdvisors(const BusOptions& options, const ChannelNames& names,
                        Node& node, EventLoop& loop) {
  std::vector<std::string> heard;
  for (const Channel channel : node.channels()) {
    if (std::find(kAdvisorChannels.begin(), kAdvisorChannels.end(), channel) !=
        kAdvisorChannels.end()) {
      heard.push_back(names.name(channel));
    }
  }
  if (heard.empty() || options.OneBus()) return Done{};
  Result<AdviceReceiver> opened =
      AdviceReceiver::Open(options.advice_url, heard);
  if (!opened) return opened.error();
  const auto receiver = std::make_shared<AdviceReceiver>(*std::move(opened));
  loop.Watch(receiver->fd(), [receiver, names, &node](Time now) {
    receiver->Drain(MonotonicMicroseconds(now), kAdvisorDatagramsPerTurn,
                    [&](const LcmDatagram& datagram, SenderAddress) {
                      node.Receive(
                          {*names.Find(datagram.channel),
                           {datagram.payload.begin(), datagram.payload.end()}},
                          now);
                    });
  });
  return Done{};
}

}  // namespace terra::bus

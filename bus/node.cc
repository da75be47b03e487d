#include "bus/node.h"

namespace terra::bus {

void Node::Receive(const RawMessage& message, Time now) {
  const RawHandler& handler =
      handlers_[static_cast<std::size_t>(message.channel)];
  if (!handler) return;
  ++received_;
  if (!handler(message.bytes, now)) ++malformed_;
}

void Node::AddCounters(Counters& counters) const {
  counters.emplace_back("received", received_);
  counters.emplace_back("malformed", malformed_);
}

}  // namespace terra::bus

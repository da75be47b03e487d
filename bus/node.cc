#include "bus/node.h"

namespace terra::bus {

void Node::Receive(const RawMessage& message, Time now) {
  const RawHandler& handler =
      handlers_[static_cast<std::size_t>(message.channel)];
  if (!handler) return;
  ++received_;
  const Status handled = handler(message.bytes, now);
  if (!handled) CountMalformed(message.channel, handled.error().message);
}

void Node::CountMalformed(Channel channel, const std::string& why) {
  ++malformed_;
  malformed_error_ = std::string(BaseName(channel)) + ": " + why;
}

void Node::AddCounters(Counters& counters) const {
  counters.emplace_back("received", received_);
  counters.emplace_back("malformed", malformed_);
}

}  // namespace terra::bus

#include "tests/support/virtual_network.h"

#include <algorithm>
#include <utility>

namespace terra::testing {

bus::Node& VirtualNetwork::Start(const std::string& name, const Factory& make) {
  auto process = std::make_unique<Process>(*this);
  process->node = make(process->out);
  bus::Node& node = *process->node;
  processes_[name] = std::move(process);
  return node;
}

void VirtualNetwork::Publish(const Port* from, bus::Channel channel,
                             std::vector<std::uint8_t> bytes) {
  int& to_lose = lose_next_[channel];
  const bool all_lose = to_lose > 0;
  if (all_lose) --to_lose;
  for (const auto& [name, process] : processes_) {
    const auto& channels = process->node->channels();
    const bool listens =
        std::find(channels.begin(), channels.end(), channel) != channels.end();
    const bool lost = lose_one_in_ > 0 && random_.OneIn(lose_one_in_);
    if (&process->port == from || !listens || lost || all_lose) {
      continue;
    }
    process->arriving.push_back(bus::RawMessage{channel, bytes});
  }
  sent_.push_back(bus::RawMessage{channel, std::move(bytes)});
}

bool VirtualNetwork::Turn() {
  bool active = false;
  for (const auto& [name, process] : processes_) {
    const auto messages = std::exchange(process->arriving, {});
    for (const bus::RawMessage& message : messages) {
      process->node->Receive(message, now_);
    }
    if (messages.empty() && process->next > now_) continue;
    process->next = process->node->Advance(now_);
    active = true;
  }
  return active;
}

void VirtualNetwork::Run(bus::Duration duration) {
  RunUntil(
      [] {
        return false;
      },
      duration);
}

bool VirtualNetwork::RunUntil(const std::function<bool()>& holds,
                              bus::Duration at_most) {
  const bus::Time end = now_ + at_most;
  while (true) {
    // Whatever is said at one time is answered at that time; a node that never
    // comes to rest would show here.
    for (int turns = 0; Turn(); ++turns) {
      if (holds()) return true;
      TERRA_REQUIRE(turns < 10'000);
    }
    if (holds()) return true;
    bus::Time next = end;
    for (const auto& [name, process] : processes_) {
      next = std::min(next, process->next);
    }
    if (now_ >= end) return false;
    now_ = std::max(next, now_ + std::chrono::microseconds(1));
    now_ = std::min(now_, end);
  }
}

}  // namespace terra::testing

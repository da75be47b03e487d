#include "tests/logger/flip_check.h"

#include <algorithm>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "tests/logger/relevance.h"

namespace terra::logger {
namespace {

using bus::Channel;

bool IsInputOrOutput(Channel channel) {
  return channel != Channel::kStatus && channel != Channel::kMapRequest &&
         channel != Channel::kLog;
}

// Each thing once: repetitions differ in utime and seq, the fields of 8 bytes
// behind fingerprint and session.
Messages SaidOnce(const Messages& run) {
  Messages once;
  std::set<std::pair<Channel, std::vector<std::uint8_t>>> said;
  for (const bus::RawMessage& message : run) {
    if (!IsInputOrOutput(message.channel)) continue;
    std::vector<std::uint8_t> essence = message.bytes;
    std::fill(essence.begin() + 8, essence.begin() + 16, 0);
    std::fill(essence.begin() + 24, essence.begin() + 32, 0);
    if (said.emplace(message.channel, std::move(essence)).second) {
      once.push_back(message);
    }
  }
  return once;
}

std::int64_t MadeAgain(const Audit& audit) {
  return audit.verdicts + audit.deployed;
}

}  // namespace

FlipCheck::FlipCheck(const Messages& run) : messages_(SaidOnce(run)) {
  const Audit honest = AuditOf(messages_);
  EXPECT_TRUE(honest.clean()) << Text(honest);
  made_again_ = MadeAgain(honest);
  nothing_follows_.resize(messages_.size());
  for (std::size_t i = 0; i < messages_.size(); ++i) {
    for (std::size_t byte = 0; byte < messages_[i].bytes.size(); ++byte) {
      places_.push_back({i, byte});
    }
  }
}

std::optional<std::string> FlipCheck::WhatIsWrong(Place place, int bit) {
  bus::RawMessage& message = messages_.at(place.message);
  const bus::RawMessage honest = message;
  message.bytes.at(place.byte) ^= static_cast<std::uint8_t>(1 << bit);
  const Audit audit = AuditOf(messages_);
  const bus::RawMessage changed = std::exchange(message, honest);
  if (!audit.clean()) {
    ++noticed_;
    return std::nullopt;
  }
  if (Irrelevant(place, changed)) {
    ++irrelevant_;
    return std::nullopt;
  }
  return std::string(bus::BaseName(honest.channel)) + ", message " +
         std::to_string(place.message) + ": byte " +
         std::to_string(place.byte) + " of " +
         std::to_string(honest.bytes.size()) + ", bit " + std::to_string(bit);
}

bool FlipCheck::Irrelevant(Place place, const bus::RawMessage& changed) {
  const bus::RawMessage& honest = messages_.at(place.message);
  return DecidesTheSame(honest, changed) || NothingFollowsFrom(place.message);
}

// Without the message every decision follows all the same.
bool FlipCheck::NothingFollowsFrom(std::size_t message) {
  std::optional<bool>& known = nothing_follows_.at(message);
  if (!known) {
    Messages others = messages_;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(message));
    const Audit audit = AuditOf(others);
    known = audit.clean() && MadeAgain(audit) == made_again_;
  }
  return *known;
}

}  // namespace terra::logger

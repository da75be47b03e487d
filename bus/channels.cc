#include "bus/channels.h"

#include <algorithm>

namespace terra::bus {
namespace {

constexpr std::size_t kMaxPrefixBytes = 32;

constexpr std::size_t LongestName() {
  std::size_t longest = 0;
  for (const std::string_view name : kBaseNames) {
    longest = std::max(longest, name.size());
  }
  return longest;
}
static_assert(kMaxPrefixBytes + 1 + LongestName() <= kMaxChannelBytes);

bool IsPrefix(std::string_view text) {
  return text.size() <= kMaxPrefixBytes &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
         });
}

bool IsMapChannel(Channel channel) {
  return channel == Channel::kMapHeader || channel == Channel::kMapTile ||
         channel == Channel::kMapRequest;
}

}  // namespace

std::string_view BaseName(Channel channel) {
  return kBaseNames[static_cast<std::size_t>(channel)];
}

ChannelNames::ChannelNames() {
  std::copy(kBaseNames.begin(), kBaseNames.end(), names_.begin());
}

Result<ChannelNames> ChannelNames::Create(const std::string& robot,
                                          const std::string& map_prefix) {
  for (const std::string& prefix : {robot, map_prefix}) {
    if (!IsPrefix(prefix)) {
      return Error{ErrorCode::kInvalid,
                   "\"" + prefix +
                       "\" is no channel prefix; give at most 32 of A-Z, 0-9"};
    }
  }
  ChannelNames names;
  for (int i = 0; i < kNumChannels; ++i) {
    const auto channel = static_cast<Channel>(i);
    const std::string& prefix =
        IsMapChannel(channel) && !map_prefix.empty() ? map_prefix : robot;
    if (!prefix.empty()) {
      std::string& name = names.names_[static_cast<std::size_t>(i)];
      name.insert(0, prefix + "_");
    }
  }
  return names;
}

std::optional<Channel> ChannelNames::Find(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<Channel>(found - names_.begin());
}

}  // namespace terra::bus

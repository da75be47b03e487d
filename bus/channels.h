#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "terrain/result.h"

namespace terra::bus {

/// Every channel of the project; one message type each (lcmtypes/).
enum class Channel {
  kMapHeader,
  kMapTile,
  kMapRequest,
  kPlanRequest,
  kBaseline,
  kAdvice,
  kVerdict,
  kDeployed,
  kPose,
  kStatus,
  kConfig,
  kLog,
  kGateStep,
};
inline constexpr int kNumChannels = 13;

/// No message is larger: one UDP datagram carries it whole, so that it arrives
/// whole or not at all.
inline constexpr std::size_t kMaxMessageBytes = 60'000;
/// Waypoints of a route and steps of its dense cells on the bus.
inline constexpr std::size_t kMaxWaypoints = 2'048;
inline constexpr std::int64_t kMaxSteps = 80'000;
inline constexpr std::size_t kMaxAnswerBytes = 16'000;
/// Names of processes, advisors, methods, models.
inline constexpr std::size_t kMaxNameBytes = 63;
/// States and errors, one line each.
inline constexpr std::size_t kMaxErrorBytes = 1'000;
/// Configurations and notes in a log.
inline constexpr std::size_t kMaxConfigBytes = 16'000;
/// LCM takes channel names up to this length.
inline constexpr std::size_t kMaxChannelBytes = 63;

/// Returns "TERRA_MAP_HEADER", ... without any prefix.
std::string_view BaseName(Channel channel);

/// The channel names of one robot. Immutable.
class ChannelNames {
 public:
  /// Without prefixes.
  ChannelNames();

  /// `robot` puts "robot_" in front of every name; `map_prefix` does so for the
  /// three map channels instead, empty = the robot's.
  /// Errors: a prefix that is not at most 32 of A-Z and 0-9.
  static Result<ChannelNames> Create(const std::string& robot,
                                     const std::string& map_prefix);

  const std::string& name(Channel channel) const {
    return names_[static_cast<std::size_t>(channel)];
  }
  /// The channel of a full name, if it is one of ours.
  std::optional<Channel> Find(std::string_view name) const;

 private:
  std::array<std::string, kNumChannels> names_;
};

}  // namespace terra::bus

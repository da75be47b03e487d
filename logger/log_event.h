#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace terra::logger {

/// One event of an LCM event log: 0xEDA1DA01, int64 number, int64 time, int32
/// channel length, int32 data length, channel, data; integers big-endian.
/// Source: LCM (Huang, Olson, Moore 2010), eventlog.h.
struct LogEvent {
  std::int64_t number = 0;   ///< From 0 in each file.
  std::int64_t time_us = 0;  ///< When it was received, since 1970.
  std::string_view channel;
  std::span<const std::uint8_t> data;
};

inline constexpr std::uint32_t kLogMagic = 0xEDA1DA01;
inline constexpr std::size_t kLogHeaderBytes = 28;
/// A file that claims more than this is damaged.
inline constexpr std::size_t kMaxLogChannel = 255;
inline constexpr std::size_t kMaxLogData = std::size_t{1} << 24;

/// Returns whether a channel can stand in our logs: 1 to kMaxLogChannel visible
/// ASCII characters, which tells a header from damage.
bool IsLogChannel(std::string_view name);

std::uint32_t ReadBigEndian32(const std::uint8_t* from);
std::int64_t ReadBigEndian64(const std::uint8_t* from);

/// Appends the bytes of an event.
/// Pre: IsLogChannel(channel), at most kMaxLogData of data.
void AppendLogEvent(std::vector<std::uint8_t>& bytes, const LogEvent& event);

/// What is found at the beginning of some bytes of a log.
struct ParsedLogEvent {
  bool valid = false;     ///< Header and channel obey the format.
  bool complete = false;  ///< ... and all its bytes are there.
  std::size_t size = 0;   ///< Bytes of the whole event, when valid.
  LogEvent event;         ///< When complete; views into the bytes.
};

/// Reads the event that begins with the first byte. Any bytes are safe.
ParsedLogEvent ParseLogEvent(std::span<const std::uint8_t> bytes);

}  // namespace terra::logger

#include "logger/log_event.h"

#include <algorithm>

#include "terrain/require.h"

namespace terra::logger {
namespace {

void AppendBigEndian(std::vector<std::uint8_t>& bytes, std::uint64_t value,
                     int width) {
  for (int shift = 8 * (width - 1); shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

bool IsVisible(char c) {
  return c > 0x20 && c < 0x7f;
}

}  // namespace

bool IsLogChannel(std::string_view name) {
  return !name.empty() && name.size() <= kMaxLogChannel &&
         std::all_of(name.begin(), name.end(), IsVisible);
}

std::uint32_t ReadBigEndian32(const std::uint8_t* from) {
  return (std::uint32_t{from[0]} << 24) | (std::uint32_t{from[1]} << 16) |
         (std::uint32_t{from[2]} << 8) | from[3];
}

std::int64_t ReadBigEndian64(const std::uint8_t* from) {
  const std::uint64_t high = ReadBigEndian32(from);
  return static_cast<std::int64_t>((high << 32) | ReadBigEndian32(from + 4));
}

void AppendLogEvent(std::vector<std::uint8_t>& bytes, const LogEvent& event) {
  TERRA_REQUIRE(IsLogChannel(event.channel) &&
                event.data.size() <= kMaxLogData);
  AppendBigEndian(bytes, kLogMagic, 4);
  AppendBigEndian(bytes, static_cast<std::uint64_t>(event.number), 8);
  AppendBigEndian(bytes, static_cast<std::uint64_t>(event.time_us), 8);
  AppendBigEndian(bytes, event.channel.size(), 4);
  AppendBigEndian(bytes, event.data.size(), 4);
  bytes.insert(bytes.end(), event.channel.begin(), event.channel.end());
  bytes.insert(bytes.end(), event.data.begin(), event.data.end());
}

ParsedLogEvent ParseLogEvent(std::span<const std::uint8_t> bytes) {
  ParsedLogEvent parsed;
  if (bytes.size() < kLogHeaderBytes ||
      ReadBigEndian32(bytes.data()) != kLogMagic) {
    return parsed;
  }
  const std::uint32_t channel_size = ReadBigEndian32(bytes.data() + 20);
  const std::uint32_t data_size = ReadBigEndian32(bytes.data() + 24);
  if (channel_size == 0 || channel_size > kMaxLogChannel ||
      data_size > kMaxLogData) {
    return parsed;
  }
  const auto rest = bytes.subspan(kLogHeaderBytes);
  const auto channel =
      rest.first(std::min<std::size_t>(rest.size(), channel_size));
  if (!std::all_of(channel.begin(), channel.end(), IsVisible)) {
    return parsed;
  }
  parsed.valid = true;
  parsed.size = kLogHeaderBytes + channel_size + data_size;
  if (bytes.size() < parsed.size) {
    return parsed;
  }
  parsed.complete = true;
  parsed.event.number = ReadBigEndian64(bytes.data() + 4);
  parsed.event.time_us = ReadBigEndian64(bytes.data() + 12);
  parsed.event.channel = {reinterpret_cast<const char*>(channel.data()),
                          channel_size};
  parsed.event.data = rest.subspan(channel_size, data_size);
  return parsed;
}

}  // namespace terra::logger

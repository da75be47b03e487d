#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace terra::chaos {

/// The bytes of one UDP datagram.
using Datagram = std::vector<std::uint8_t>;

/// LCM's one-datagram form: "LC02", big-endian uint32 sequence number, channel
/// name with its NUL, payload.
Datagram WholeMessage(std::uint32_t sequence, std::string_view channel,
                      std::span<const std::uint8_t> payload);

/// The header of one datagram of LCM's fragmented form ("LC03"). Nothing is
/// checked: any field may lie.
struct FragmentHeader {
  std::uint32_t sequence = 0;
  std::uint32_t message_bytes = 0;  ///< Payload of all fragments together.
  std::uint32_t offset = 0;         ///< Of this fragment's payload.
  std::uint16_t number = 0;
  std::uint16_t count = 0;
};

/// The channel is written into fragment number 0 only.
Datagram Fragment(const FragmentHeader& header, std::string_view channel,
                  std::span<const std::uint8_t> payload);

/// A whole message in fragments, as LCM sends one that fits no datagram.
std::vector<Datagram> Fragments(std::uint32_t sequence,
                                std::string_view channel,
                                std::span<const std::uint8_t> payload,
                                std::size_t fragment_bytes = 60'000);

}  // namespace terra::chaos

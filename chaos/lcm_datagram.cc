#include "chaos/lcm_datagram.h"

#include <algorithm>

namespace terra::chaos {
namespace {

constexpr std::uint32_t kWholeMagic = 0x4c433032;     // "LC02"
constexpr std::uint32_t kFragmentMagic = 0x4c433033;  // "LC03"

void AppendBigEndian(Datagram& to, std::uint32_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    to.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

void AppendName(Datagram& to, std::string_view channel) {
  to.insert(to.end(), channel.begin(), channel.end());
  to.push_back(0);
}

}  // namespace

Datagram WholeMessage(std::uint32_t sequence, std::string_view channel,
                      std::span<const std::uint8_t> payload) {
  Datagram datagram;
  AppendBigEndian(datagram, kWholeMagic, 4);
  AppendBigEndian(datagram, sequence, 4);
  AppendName(datagram, channel);
  datagram.insert(datagram.end(), payload.begin(), payload.end());
  return datagram;
}

Datagram Fragment(const FragmentHeader& header, std::string_view channel,
                  std::span<const std::uint8_t> payload) {
  Datagram datagram;
  AppendBigEndian(datagram, kFragmentMagic, 4);
  AppendBigEndian(datagram, header.sequence, 4);
  AppendBigEndian(datagram, header.message_bytes, 4);
  AppendBigEndian(datagram, header.offset, 4);
  AppendBigEndian(datagram, header.number, 2);
  AppendBigEndian(datagram, header.count, 2);
  if (header.number == 0) AppendName(datagram, channel);
  datagram.insert(datagram.end(), payload.begin(), payload.end());
  return datagram;
}

std::vector<Datagram> Fragments(std::uint32_t sequence,
                                std::string_view channel,
                                std::span<const std::uint8_t> payload,
                                std::size_t fragment_bytes) {
  FragmentHeader header;
  header.sequence = sequence;
  header.message_bytes = static_cast<std::uint32_t>(payload.size());
  header.count = static_cast<std::uint16_t>(
      (payload.size() + fragment_bytes - 1) / fragment_bytes);
  std::vector<Datagram> fragments;
  while (header.offset < payload.size()) {
    const auto part = payload.subspan(
        header.offset,
        std::min(fragment_bytes, payload.size() - header.offset));
    fragments.push_back(Fragment(header, channel, part));
    header.offset += static_cast<std::uint32_t>(part.size());
    ++header.number;
  }
  return fragments;
}

}  // namespace terra::chaos

#include "bus/subscribers.h"

#include <charconv>
#include <fstream>
#include <string_view>

#include "bus/lcm_url.h"

namespace terra::bus {

// A line: "  12: 43FFEFEF:1DF3 00000000:0000 07 ...", the port in hex digits
// after the second colon.
std::int64_t CountUdpSockets(std::istream& table, int port) {
  std::int64_t sockets = 0;
  std::string slot;
  std::string address;
  std::string rest;
  while (table >> slot >> address && std::getline(table, rest)) {
    const std::size_t colon = address.find(':');
    if (colon == std::string::npos) continue;  // The heading.
    const std::string_view digits = std::string_view(address).substr(colon + 1);
    int bound = 0;
    const auto read = std::from_chars(digits.data(),
                                      digits.data() + digits.size(), bound, 16);
    if (read.ec == std::errc() && bound == port) ++sockets;
  }
  return sockets;
}

std::int64_t CountSubscribers(const std::string& url) {
  const Result<LcmUrl> bus = ParseLcmUrl(url);
  if (!bus || !bus->is_udpm()) return 0;
  std::ifstream table("/proc/self/net/udp");
  return CountUdpSockets(table, bus->port);
}

std::string SubscribersWarning(std::int64_t sockets) {
  if (sockets < kManySubscribers) return {};
  return std::to_string(sockets) +
         " sockets of this host hear the deployed bus, and whoever sends waits "
         "for each of them (some 2.4 us a socket and message): end programs "
         "that do not need it";
}

}  // namespace terra::bus

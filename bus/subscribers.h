#pragma once

#include <cstdint>
#include <istream>
#include <string>

namespace terra::bus {

/// From so many sockets on one bus on, somebody should hear of it: the kernel
/// copies each message to each of them while its sender waits, some 2.4 us a
/// socket.
inline constexpr std::int64_t kManySubscribers = 100;

/// Counts the sockets that are bound to a UDP port, whether anybody reads them
/// or not. `table` is the text of /proc/self/net/udp.
std::int64_t CountUdpSockets(std::istream& table, int port);

/// Counts them for the port of a udpm:// URL on this host; 0 for other URLs and
/// where the system does not tell.
std::int64_t CountSubscribers(const std::string& url);

/// What to say of so many: empty below kManySubscribers.
std::string SubscribersWarning(std::int64_t sockets);

}  // namespace terra::bus

#pragma once

#include <cstdint>
#include <string>

#include "chaos/lcm_datagram.h"
#include "terrain/result.h"

namespace terra::chaos {

/// Sends datagrams as they are to the group of a udpm:// URL, with ttl 0, so
/// that they never leave the host. LCM would send well-formed ones only.
class DatagramSocket {
 public:
  /// Errors: kInvalid for a URL that is not udpm; kUnavailable when the system
  /// refuses, with the reason.
  static Result<DatagramSocket> Open(const std::string& url);

  DatagramSocket(DatagramSocket&& other) noexcept;
  DatagramSocket& operator=(DatagramSocket&& other) noexcept;
  ~DatagramSocket();

  /// Returns false when the system refused it (too long, no route).
  bool Send(const Datagram& datagram);

 private:
  DatagramSocket(int fd, std::uint32_t group, std::uint16_t port)
      : fd_(fd), group_(group), port_(port) {}

  int fd_ = -1;
  std::uint32_t group_ = 0;  // Host order.
  std::uint16_t port_ = 0;
};

}  // namespace terra::chaos

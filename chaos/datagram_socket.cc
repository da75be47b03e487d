#include "chaos/datagram_socket.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>

#include "bus/lcm_url.h"

namespace terra::chaos {

Result<DatagramSocket> DatagramSocket::Open(const std::string& url) {
  const Result<bus::LcmUrl> to = bus::ParseLcmUrl(url);
  if (!to) return to.error();
  if (!to->is_udpm()) {
    return Error{ErrorCode::kInvalid,
                 "datagrams are sent to udpm:// buses only, not to " + url};
  }
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const unsigned char ttl = 0;
  if (fd < 0 ||
      setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) != 0) {
    const Error error{
        ErrorCode::kUnavailable,
        "cannot open a socket for " + url + ": " + std::strerror(errno)};
    if (fd >= 0) close(fd);
    return error;
  }
  return DatagramSocket(fd, to->address, static_cast<std::uint16_t>(to->port));
}

DatagramSocket::DatagramSocket(DatagramSocket&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      group_(other.group_),
      port_(other.port_) {}

DatagramSocket& DatagramSocket::operator=(DatagramSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(group_, other.group_);
  std::swap(port_, other.port_);
  return *this;
}

DatagramSocket::~DatagramSocket() {
  if (fd_ >= 0) close(fd_);
}

bool DatagramSocket::Send(const Datagram& datagram) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(group_);
  to.sin_port = htons(port_);
  const ssize_t sent =
      sendto(fd_, datagram.data(), datagram.size(), MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
  return sent == static_cast<ssize_t>(datagram.size());
}

}  // namespace terra::chaos

#include "bus/udpm_receiver.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "bus/lcm_url.h"

namespace terra::bus {
namespace {

constexpr std::size_t kHeaderBytes = 8;
constexpr std::uint32_t kMagicShort = 0x4c433032;     // "LC02"
constexpr std::uint32_t kMagicFragment = 0x4c433033;  // "LC03"
constexpr int kDefaultRecvBuffer = 2 << 20;
// One byte more than the largest message, so that a longer one is seen as cut.
constexpr std::size_t kSlotBytes =
    kHeaderBytes + kMaxChannelName + 1 + kMaxDatagramPayload;

std::uint32_t BigEndian32(const std::uint8_t* at) {
  return (std::uint32_t{at[0]} << 24) | (std::uint32_t{at[1]} << 16) |
         (std::uint32_t{at[2]} << 8) | at[3];
}

bool IsFragment(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= sizeof(std::uint32_t) &&
         BigEndian32(bytes.data()) == kMagicFragment;
}

Error SystemError(const std::string& what, const std::string& url) {
  return Error{ErrorCode::kUnavailable,
               what + " for " + url + ": " + std::strerror(errno)};
}

// Binds and joins as LCM does (SO_REUSEADDR, any interface), but to the group's
// address: LCM 1.3.1 binds to all addresses and hears other groups too.
Status Listen(int fd, const LcmUrl& to, const std::string& url) {
  const int yes = 1;
  if (setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) != 0) {
    return SystemError("cannot share the port", url);
  }
  const int size = to.recv_buf_size > 0 ? to.recv_buf_size : kDefaultRecvBuffer;
  // The kernel may give less, and not every kernel counts its drops; both only
  // change how much of a burst is seen.
  setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof(size));
  setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &yes, sizeof(yes));

  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(to.address);
  address.sin_port = htons(static_cast<std::uint16_t>(to.port));
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) !=
      0) {
    const std::string port = std::to_string(to.port);
    return SystemError(errno == EADDRINUSE
                           ? "UDP port " + port +
                                 " is taken by another program; choose another"
                           : "cannot listen",
                       url);
  }
  ip_mreq membership{};
  membership.imr_multiaddr.s_addr = htonl(to.address);
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  if (setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership,
                 sizeof(membership)) != 0) {
    return SystemError(
        "cannot join the multicast group (is there a multicast route?)", url);
  }
  return Done{};
}

}  // namespace

std::optional<LcmDatagram> ParseLcmDatagram(
    std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes || BigEndian32(bytes.data()) != kMagicShort) {
    return std::nullopt;
  }
  const auto rest = bytes.subspan(kHeaderBytes);
  const auto window = rest.first(std::min(rest.size(), kMaxChannelName + 1));
  const auto nul = std::find(window.begin(), window.end(), std::uint8_t{0});
  if (nul == window.begin() || nul == window.end() ||
      !std::all_of(window.begin(), nul, [](std::uint8_t c) {
        return c > 0x20 && c < 0x7f;
      })) {
    return std::nullopt;
  }
  const auto length = static_cast<std::size_t>(nul - window.begin());
  LcmDatagram datagram;
  datagram.sequence = BigEndian32(bytes.data() + 4);
  datagram.channel = {reinterpret_cast<const char*>(rest.data()), length};
  datagram.payload = rest.subspan(length + 1);
  if (datagram.payload.size() > kMaxDatagramPayload) {
    return std::nullopt;
  }
  return datagram;
}

Result<UdpmReceiver> UdpmReceiver::Open(const std::string& url) {
  const Result<LcmUrl> to = ParseLcmUrl(url);
  if (!to) {
    return to.error();
  }
  if (!to->is_udpm()) {
    return Error{ErrorCode::kInvalid,
                 "datagrams are read from udpm:// buses only, not from " + url};
  }
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) {
    return SystemError("cannot open a socket", url);
  }
  UdpmReceiver receiver(fd);
  if (const Status listening = Listen(fd, *to, url); !listening) {
    return listening.error();
  }
  return receiver;
}

UdpmReceiver::UdpmReceiver(int fd) : fd_(fd), buffer_(kBatch * kSlotBytes) {}

UdpmReceiver::UdpmReceiver(UdpmReceiver&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      counters_(other.counters_),
      buffer_(std::move(other.buffer_)) {}

UdpmReceiver& UdpmReceiver::operator=(UdpmReceiver&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(counters_, other.counters_);
  std::swap(buffer_, other.buffer_);
  return *this;
}

UdpmReceiver::~UdpmReceiver() {
  if (fd_ >= 0) {
    close(fd_);
  }
}

std::size_t UdpmReceiver::Drain(std::size_t max_datagrams,
                                const Handler& handler) {
  // Room for the kernel's drop counter of one message.
  struct alignas(cmsghdr) Control {
    std::array<char, CMSG_SPACE(sizeof(std::uint32_t))> bytes;
  };
  std::array<Control, kBatch> control;
  std::array<sockaddr_in, kBatch> from{};
  std::array<iovec, kBatch> vectors{};
  std::array<mmsghdr, kBatch> messages{};

  std::size_t read = 0;
  while (read < max_datagrams) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      vectors[i] = {buffer_.data() + i * kSlotBytes, kSlotBytes};
      msghdr& header = messages[i].msg_hdr;
      header = {};
      header.msg_name = &from[i];
      header.msg_namelen = sizeof(from[i]);
      header.msg_iov = &vectors[i];
      header.msg_iovlen = 1;
      header.msg_control = &control[i];
      header.msg_controllen = sizeof(control[i]);
    }
    const std::size_t wanted = std::min(kBatch, max_datagrams - read);
    const int got = recvmmsg(fd_, messages.data(),
                             static_cast<unsigned>(wanted), 0, nullptr);
    if (got <= 0) {
      break;  // Empty, a signal, or an error that passes by itself.
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) {
      msghdr& header = messages[i].msg_hdr;
      const cmsghdr* const note = CMSG_FIRSTHDR(&header);
      if (note != nullptr && note->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t lost = 0;
        std::memcpy(&lost, CMSG_DATA(note), sizeof(lost));
        counters_.lost_in_kernel = lost;
      }
      ++counters_.received;
      const SenderAddress sender{ntohl(from[i].sin_addr.s_addr),
                                 ntohs(from[i].sin_port)};
      Take({buffer_.data() + i * kSlotBytes, messages[i].msg_len},
           (header.msg_flags & MSG_TRUNC) != 0, sender, handler);
    }
    read += static_cast<std::size_t>(got);
    if (static_cast<std::size_t>(got) < wanted) {
      break;
    }
  }
  return read;
}

void UdpmReceiver::Take(std::span<const std::uint8_t> bytes, bool cut,
                        SenderAddress sender, const Handler& handler) {
  if (IsFragment(bytes)) {
    ++counters_.fragments;
    return;
  }
  const std::optional<LcmDatagram> datagram = ParseLcmDatagram(bytes);
  if (cut || !datagram) {
    ++counters_.malformed;
  } else {
    handler(*datagram, sender);
  }
}

}  // namespace terra::bus

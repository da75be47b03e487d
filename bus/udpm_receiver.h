#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/result.h"

namespace terra::bus {

/// One LCM message that arrived in one datagram. Views into the bytes it was
/// read from.
struct LcmDatagram {
  std::uint32_t sequence = 0;
  std::string_view channel;
  std::span<const std::uint8_t> payload;
};

inline constexpr std::size_t kMaxDatagramPayload = 60'000;  ///< Bytes.
inline constexpr std::size_t kMaxChannelName = 63;          ///< Bytes.

/// Reads LCM's one-datagram form: "LC02", a big-endian uint32 sequence number,
/// the channel name with its NUL, the payload. Nothing else is taken: no
/// fragments ("LC03"), no empty, long or unprintable name, no payload above
/// kMaxDatagramPayload. Any bytes are safe.
std::optional<LcmDatagram> ParseLcmDatagram(
    std::span<const std::uint8_t> bytes);

/// IPv4 address and UDP port, both in host order.
struct SenderAddress {
  std::uint32_t address = 0;
  std::uint16_t port = 0;

  friend auto operator<=>(const SenderAddress&, const SenderAddress&) = default;
};

/// The bounded receiver of a udpm:// bus. Every process of the project hears
/// udpm buses with it.
///
/// liblcm (1.3.1 to 1.5.2) can be made to crash by one packet. Here a message
/// is one datagram: it is taken whole or refused and counted, and no byte that
/// arrives can do more than that. The memory is the same for any traffic.
///
/// Threads: one thread owns it. It has no thread of its own; wait for fd().
class UdpmReceiver {
 public:
  /// The view is valid during the call only.
  using Handler = std::function<void(const LcmDatagram&, SenderAddress)>;

  /// What became of the datagrams read so far.
  struct Counters {
    std::uint64_t received = 0;        ///< Read, taken or not.
    std::uint64_t fragments = 0;       ///< Refused: pieces of a larger message.
    std::uint64_t malformed = 0;       ///< Refused: no LCM message, too large.
    std::uint64_t lost_in_kernel = 0;  ///< Dropped before they could be read.
  };

  /// Opens a socket on the group and port of a udpm:// URL, beside any number
  /// of other listeners, LCM's own included. The group is joined on the
  /// interface of the multicast route, as LCM does; `ttl` is for senders only;
  /// the receive buffer is the URL's recv_buf_size, else 2 MB, as far as the
  /// kernel gives it.
  ///
  /// Errors: kInvalid for a URL that is not udpm; kUnavailable when the system
  /// refuses, with the reason (no multicast route, port in use).
  static Result<UdpmReceiver> Open(const std::string& url);

  UdpmReceiver(UdpmReceiver&& other) noexcept;
  UdpmReceiver& operator=(UdpmReceiver&& other) noexcept;
  ~UdpmReceiver();

  /// To be polled for reading.
  int fd() const { return fd_; }

  /// Reads what has arrived, at most max_datagrams, without waiting, and hands
  /// over the messages among it. Returns how many datagrams were read; less
  /// than max_datagrams = the socket is empty.
  std::size_t Drain(std::size_t max_datagrams, const Handler& handler);

  const Counters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kBatch = 16;

  explicit UdpmReceiver(int fd);
  void Take(std::span<const std::uint8_t> bytes, bool cut, SenderAddress sender,
            const Handler& handler);

  int fd_ = -1;
  Counters counters_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace terra::bus

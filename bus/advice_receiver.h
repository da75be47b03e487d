#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
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

/// Admits at most per_sender messages of one sender and at most `all` messages
/// together in any second (sliding windows, not buckets: the bound holds for
/// every second). Only admitted senders are remembered, so the table never has
/// more than `all` rows, whatever addresses are forged.
///
/// Units: microseconds of any clock; a clock that runs back counts as standing.
class AdviceRateLimiter {
 public:
  struct Limits {
    std::size_t per_sender = 20;
    std::size_t all = 200;
  };

  AdviceRateLimiter() = default;
  explicit AdviceRateLimiter(Limits limits) : limits_(limits) {}

  bool Admit(SenderAddress sender, std::int64_t now_us);

  std::size_t num_senders() const { return of_sender_.size(); }

 private:
  Limits limits_;
  std::int64_t now_us_ = 0;
  struct Admission {
    std::int64_t time_us = 0;
    SenderAddress sender;
  };
  std::deque<Admission> last_second_;               // Oldest first.
  std::map<SenderAddress, std::size_t> of_sender_;  // Rows in last_second_.
};

/// The bounded receiver of the advice bus, for gate and logger.
///
/// liblcm (1.3.1 to 1.5.2) can be made to crash by one packet, and its queues
/// keep the oldest messages of a flood. So the advice bus is read from a socket
/// of its own: everything is read (so that the socket's buffer does not fill
/// with a flood), only whole messages of one channel are taken, and of those no
/// more than the limiter admits. The rest is counted. No byte that arrives can
/// do more than that.
///
/// Threads: one thread owns it. It has no thread of its own; wait for fd().
class AdviceReceiver {
 public:
  /// The view is valid during the call only.
  using Handler = std::function<void(const LcmDatagram&, SenderAddress)>;

  /// What became of the datagrams read so far.
  struct Counters {
    std::uint64_t received = 0;        ///< All that follow, together.
    std::uint64_t delivered = 0;       ///< Handed over.
    std::uint64_t malformed = 0;       ///< No LCM message, or too large.
    std::uint64_t other_channel = 0;   ///< Not for us.
    std::uint64_t over_limit = 0;      ///< Refused by the limiter.
    std::uint64_t lost_in_kernel = 0;  ///< Dropped before they could be read.
  };

  /// Opens a socket on the group and port of a udpm:// URL, beside any number
  /// of other listeners, LCM's own included. Takes messages of `channel` only.
  /// (For memq:// and file:// URLs a Bus on the same URL does the work.)
  ///
  /// Errors: kInvalid for a URL that is not udpm; kUnavailable when the system
  /// refuses, with the reason (no multicast route, port in use).
  static Result<AdviceReceiver> Open(const std::string& url,
                                     std::string channel,
                                     AdviceRateLimiter::Limits limits = {});

  AdviceReceiver(AdviceReceiver&& other) noexcept;
  AdviceReceiver& operator=(AdviceReceiver&& other) noexcept;
  ~AdviceReceiver();

  /// To be polled for reading.
  int fd() const { return fd_; }

  /// Reads what has arrived, at most max_datagrams, without waiting, and hands
  /// over what is admitted. now_us is the caller's monotonic clock. Returns how
  /// many datagrams were read; less than max_datagrams = the socket is empty.
  std::size_t Drain(std::int64_t now_us, std::size_t max_datagrams,
                    const Handler& handler);

  const Counters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kBatch = 16;

  AdviceReceiver(int fd, std::string channel, AdviceRateLimiter limiter);
  void Take(std::span<const std::uint8_t> bytes, SenderAddress sender,
            std::int64_t now_us, const Handler& handler);

  int fd_ = -1;
  std::string channel_;
  AdviceRateLimiter limiter_;
  Counters counters_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace terra::bus

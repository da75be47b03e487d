#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bus/udpm_receiver.h"
#include "terrain/result.h"

namespace terra::bus {

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

/// The receiver of the advice bus: advisors say there all that they say.
///
/// A UdpmReceiver, of whose messages only those of some channels are taken, and
/// of each channel no more than its own limiter admits: a flood on one channel
/// leaves the others alone. Everything is read, so that the socket's buffer
/// does not fill with a flood. What is not handed over is counted.
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

  /// Listens on a udpm:// URL to `channels`, each within `limits`. (For memq://
  /// and file:// URLs a Bus on the same URL does the work.)
  ///
  /// Errors: those of UdpmReceiver::Open.
  static Result<AdviceReceiver> Open(const std::string& url,
                                     const std::vector<std::string>& channels,
                                     AdviceRateLimiter::Limits limits = {});
  static Result<AdviceReceiver> Open(const std::string& url,
                                     const std::string& channel,
                                     AdviceRateLimiter::Limits limits = {}) {
    return Open(url, std::vector<std::string>{channel}, limits);
  }

  /// To be polled for reading.
  int fd() const { return receiver_.fd(); }

  /// Reads what has arrived, at most max_datagrams, without waiting, and hands
  /// over what is admitted. now_us is the caller's monotonic clock. Returns how
  /// many datagrams were read; less than max_datagrams = the socket is empty.
  std::size_t Drain(std::int64_t now_us, std::size_t max_datagrams,
                    const Handler& handler);

  /// Of all channels together.
  const Counters& counters() const { return counters_; }
  /// Messages of one channel that its limiter refused.
  std::uint64_t over_limit(const std::string& channel) const;

 private:
  struct Heard {
    std::string channel;
    AdviceRateLimiter limiter;
    std::uint64_t over_limit = 0;
  };

  AdviceReceiver(UdpmReceiver receiver, std::vector<Heard> heard)
      : receiver_(std::move(receiver)), heard_(std::move(heard)) {}
  void Take(const LcmDatagram& datagram, SenderAddress sender,
            std::int64_t now_us, const Handler& handler);

  UdpmReceiver receiver_;
  std::vector<Heard> heard_;
  Counters counters_;
};

}  // namespace terra::bus

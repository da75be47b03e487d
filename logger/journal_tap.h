#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <utility>

#include "bus/udpm_receiver.h"
#include "terrain/result.h"
#include "verifier/journal_budget.h"

namespace terra::logger {

/// Which socket speaks for which session of a gate: the one that did first. So
/// a step that another program made up under the session of a gate that was
/// heard before does not reach the log. Bounds: the kMaxSpeakers that spoke
/// last.
class JournalSpeakers {
 public:
  static constexpr std::size_t kMaxSpeakers = 1'024;
  /// A gate keeps its journal within the first in any second.
  static constexpr verifier::JournalBudget::Limits kOfOne{
      .bytes_per_s = 1'000'000, .burst = 1'000'000};
  static constexpr verifier::JournalBudget::Limits kOfAll{
      .bytes_per_s = 8'000'000, .burst = 8'000'000};

  /// Returns whether this socket may speak for this session.
  bool MaySpeak(bus::SenderAddress sender, std::int64_t session);
  /// Returns whether who spoke last may say so many bytes now.
  /// Pre: MaySpeak returned true.
  bool MaySay(std::int64_t bytes, std::int64_t now_us);

 private:
  struct Speaker {
    bus::SenderAddress sender;
    std::int64_t session = 0;
    verifier::JournalBudget budget{kOfOne};
  };

  std::list<Speaker> speakers_;  // Who spoke last is first.
  verifier::JournalBudget of_all_{kOfAll};
};

/// Hears the gates' journal on its own port. A gate keeps its journal within
/// 1 MB a second; of one socket no more is taken, and of all 8 MB a second.
/// Threads: one thread owns it.
class JournalTap {
 public:
  using Handler = bus::UdpmReceiver::Handler;
  struct Counters {
    std::uint64_t foreign = 0;  ///< Another channel, session or speaker.
    std::uint64_t over_limit = 0;
    std::uint64_t lost_in_kernel = 0;
  };

  /// Errors: those of UdpmReceiver::Open.
  static Result<JournalTap> Open(const std::string& url,
                                 const std::string& channel);

  int fd() const { return receiver_.fd(); }
  /// Reads what has arrived, at most max_datagrams, without waiting.
  void Drain(std::int64_t now_us, std::size_t max_datagrams,
             const Handler& handler);
  const Counters& counters() const { return counters_; }

 private:
  JournalTap(bus::UdpmReceiver receiver, std::string channel)
      : receiver_(std::move(receiver)), channel_(std::move(channel)) {}
  bool Admit(const bus::LcmDatagram& datagram, bus::SenderAddress sender,
             std::int64_t now_us);

  bus::UdpmReceiver receiver_;
  std::string channel_;
  JournalSpeakers speakers_;
  Counters counters_;
};

}  // namespace terra::logger

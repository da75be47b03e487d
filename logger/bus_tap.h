#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "bus/advice_receiver.h"
#include "bus/channels.h"
#include "bus/lcm_link.h"
#include "bus/time.h"
#include "logger/event_queue.h"
#include "logger/journal_tap.h"
#include "terrain/result.h"

struct pollfd;

namespace terra::logger {

/// Hears every channel of the deployed bus, the project's or not; on the advice
/// bus what advisors say, each channel within its limits; and the gates'
/// journal on its own port, where alone it is taken.
///
/// Bounds: a receive buffer as large as the kernel gives (up to 16 MB), then
/// the
///         EventQueue.
/// Threads: one of its own fills the queue and does nothing else; the counts
///          may be read from any.
class BusTap {
 public:
  struct Urls {
    std::string deployed;
    std::string advice;   ///< The same as deployed: it is opened once.
    std::string journal;  ///< The same.
  };
  struct Counters {
    std::atomic<std::int64_t> heard{0};
    std::atomic<std::int64_t> refused{0};
    /// Datagrams of the deployed bus, as in bus::UdpmReceiver::Counters.
    std::atomic<std::int64_t> fragments{0};
    std::atomic<std::int64_t> no_message{0};
    std::atomic<std::int64_t> lost_in_kernel{0};
    std::atomic<std::int64_t> advice_over_limit{0};
    std::atomic<std::int64_t> advisors_over_limit{0};  ///< Not ADVICE.
    std::atomic<std::int64_t> advice_malformed{0};
    std::atomic<std::int64_t> advice_lost_in_kernel{0};
    /// As in JournalTap::Counters.
    std::atomic<std::int64_t> journal_foreign{0};
    std::atomic<std::int64_t> journal_over_limit{0};
    std::atomic<std::int64_t> journal_lost_in_kernel{0};
  };

  /// The queue must outlive the tap.
  /// Errors: a bus that cannot be heard, with what to do about it.
  static Result<std::unique_ptr<BusTap>> Open(const Urls& urls,
                                              const bus::ChannelNames& names,
                                              EventQueue& queue);
  /// Hears what was sent before, then ends.
  ~BusTap();
  BusTap(const BusTap&) = delete;
  BusTap& operator=(const BusTap&) = delete;

  const Counters& counters() const { return counters_; }

 private:
  BusTap(EventQueue& queue, std::unique_ptr<bus::LcmLink> link, int stop_fd);
  static void OnMessage(std::string_view channel,
                        std::span<const std::uint8_t> bytes,
                        void* tap) noexcept;
  void Listen();
  void HearDeployedBus(pollfd& lcm, int silence_ms, bus::Duration at_most);
  Status OpenAdvice(const std::string& url, const bus::ChannelNames& names);
  Status OpenJournal(const std::string& url);
  bool IsApart(const std::string& url) const;
  void Take(const bus::LcmDatagram& datagram);
  void DrainAdvice();
  void DrainJournal();

  EventQueue& queue_;
  std::unique_ptr<bus::LcmLink> link_;
  int stop_fd_;
  std::optional<bus::AdviceReceiver> advice_;
  std::string advice_channel_;
  std::optional<JournalTap> journal_;
  std::string journal_channel_;
  Counters counters_;
  std::thread thread_;
};

/// Returns the URL with a recv_buf_size of at least `bytes`; other URLs than
/// udpm://, and what is no URL, as they are.
std::string WithReceiveBuffer(const std::string& url, std::int64_t bytes);

}  // namespace terra::logger

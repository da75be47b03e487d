#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bus/channels.h"
#include "bus/inbox.h"
#include "bus/lcm_link.h"
#include "bus/transport.h"
#include "terrain/result.h"

namespace terra::bus {

/// Says why a bus cannot be used. liblcm does not tell why it failed, so this
/// tries the two usual reasons: no multicast route, and a port that is taken.
/// `otherwise` is the text of the error when it is neither.
Error DiagnoseBus(const std::string& url, const std::string& otherwise);

/// One LCM bus: opens it with checks, publishes, and receives in a thread that
/// does nothing but fill inboxes.
///
/// Errors: a bus that cannot work at all (no multicast route, busy port,
///         firewall) is an Error that says what to do. A route that is lost
///         later is not: publishes fail, are counted, and work again when it
///         comes back. So is no tcpq:// hub that is away (see LcmLink).
/// Threads: Publish from any thread; the rest from the thread that made it.
class Bus : public Transport {
 public:
  /// Counts since the start; any thread may read them.
  struct Counters {
    std::atomic<std::int64_t> sent{0};
    std::atomic<std::int64_t> send_failed{0};
    std::atomic<std::int64_t> received{0};
    std::atomic<std::int64_t> oversized{0};
    /// Datagrams of a udpm:// bus: pieces of larger messages, and what is no
    /// message; what the kernel dropped before it was read.
    std::atomic<std::int64_t> fragments{0};
    std::atomic<std::int64_t> no_message{0};
    std::atomic<std::int64_t> lost_in_kernel{0};
  };

  static Result<std::unique_ptr<Bus>> Open(const std::string& url,
                                           ChannelNames names,
                                           Use use = Use::kSendAndHear);
  ~Bus() override;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Receives these channels into an inbox, which must outlive the bus. To be
  /// called once. With memq:// what this bus publishes comes back to it.
  Status Listen(std::span<const Channel> channels, Inbox& inbox);

  /// Refuses messages above kMaxMessageBytes.
  bool Publish(Channel channel, std::span<const std::uint8_t> bytes) override;

  const std::string& url() const { return url_; }
  const Counters& counters() const { return counters_; }

 private:
  struct Subscription {
    Bus* bus;
    Channel channel;
  };

  Bus(std::unique_ptr<LcmLink> link, ChannelNames names);
  static void OnMessage(std::string_view channel,
                        std::span<const std::uint8_t> bytes,
                        void* subscription) noexcept;
  Status StartReceiving();
  void Receive();
  void CountDatagrams();

  std::unique_ptr<LcmLink> link_;
  std::string url_;
  ChannelNames names_;
  Counters counters_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  Inbox* inbox_ = nullptr;
  int stop_fd_ = -1;
  std::thread receiver_;
};

}  // namespace terra::bus

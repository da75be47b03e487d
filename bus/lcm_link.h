#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "bus/lcm_url.h"
#include "bus/udpm_receiver.h"
#include "terrain/result.h"

struct _lcm_t;

namespace terra::bus {

/// What everybody who opens a udpm:// bus sends once, to see whether it comes
/// back: liblcm, and LcmLink.
inline constexpr char kSelfTestChannel[] = "LCM_SELF_TEST";

/// What a connection is for. One that only hears sends nothing at all, and so
/// cannot see whether what is sent would come back.
enum class Use { kSendAndHear, kHear };

/// One connection to an LCM bus. liblcm sends, and reads memq://, file:// and
/// tcpq://; udpm:// is read by a UdpmReceiver, since one packet can end a
/// process that reads it with liblcm.
///
/// The hub of a tcpq:// bus may be away, at the start or later. Then nothing is
/// sent or heard, which is said once; the hub is looked for twice a second, and
/// what was subscribed is subscribed again. liblcm would try at each message,
/// wait for ever for a hub that accepts and does not answer, and write two
/// lines about each try.
///
/// Threads: Publish and Subscribe from any; Handle from one that waits for
///          fd(). A link to a tcpq:// bus needs that thread even if it only
///          publishes.
class LcmLink {
 public:
  /// The views are valid during the call only.
  using Handler = void (*)(std::string_view channel,
                           std::span<const std::uint8_t> bytes, void* user);
  /// One call of Handle takes no more messages.
  static constexpr std::size_t kMessagesPerHandle = 64;

  /// Errors: a URL that is none, or that liblcm refuses.
  static Result<std::unique_ptr<LcmLink>> Open(const std::string& url,
                                               Use use = Use::kSendAndHear);
  ~LcmLink();
  LcmLink(const LcmLink&) = delete;
  LcmLink& operator=(const LcmLink&) = delete;

  const LcmUrl& url() const { return url_; }

  /// Receives one channel, or every one: ".*". `handler` is called from Handle,
  /// with `user`. Where liblcm reads it holds at most `queue_capacity`
  /// messages. Errors: a bus that does not carry what is sent.
  Status Subscribe(const std::string& channel, Handler handler, void* user,
                   int queue_capacity);

  /// Returns false when the message could not be sent; with Use::kHear always.
  /// A hub that takes nothing
  /// delays this by kSendPatience, once.
  bool Publish(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// Readable when there is something for Handle. The same for the life of the
  /// link, once there is a subscription or the bus is a tcpq:// one.
  int fd() const;
  /// Takes some messages, or sees to a hub that went away or came back. Returns
  /// false when nothing will come any more, which is said: a file:// bus was
  /// played to its end. (Its descriptor stays readable for ever.)
  bool Handle();

  /// Of a udpm:// bus; elsewhere all are 0. For the thread of Handle.
  UdpmReceiver::Counters counters() const;

 private:
  struct Subscription {
    std::string channel;
    Handler handler;
    void* user;
    int queue_capacity;
  };

  LcmLink(LcmUrl url, Use use) : url_(std::move(url)), use_(use) {}
  Status OpenTcpq();
  Status OpenReceiver();
  bool SubscribeTo(Subscription& subscription);
  void HandleUdpm();
  void HandleTcpq();
  void Connect();
  void Drop();
  bool HasEnded() const;
  bool HasMessage() const;
  void LookAgainIn(std::int64_t milliseconds) const;

  const LcmUrl url_;
  const Use use_;
  mutable std::mutex mutex_;                // For all below.
  std::deque<Subscription> subscriptions_;  // liblcm is given their addresses.
  std::optional<UdpmReceiver> receiver_;  // udpm: from the first subscription.
  _lcm_t* in_ = nullptr;
  // A tcpq:// bus is sent to over a connection of its own, since liblcm closes
  // one that fails, whoever else uses it. Else the same as in_.
  _lcm_t* out_ = nullptr;
  bool failed_ = false;  // tcpq: a publish has.
  bool away_ = false;    // tcpq: it was said that the hub is.
  int epoll_fd_ = -1;    // tcpq: both sockets and the timer.
  int timer_fd_ = -1;    // tcpq: when to look for the hub.
};

}  // namespace terra::bus

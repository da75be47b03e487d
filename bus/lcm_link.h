#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bus/lcm_url.h"
#include "terrain/result.h"

struct _lcm_t;
struct _lcm_recv_buf_t;

namespace terra::bus {

/// One connection to an LCM bus through liblcm.
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
  using Handler = void (*)(const _lcm_recv_buf_t* buffer, const char* channel,
                           void* user);

  /// Errors: a URL that is none, or that liblcm refuses.
  static Result<std::unique_ptr<LcmLink>> Open(const std::string& url);
  ~LcmLink();
  LcmLink(const LcmLink&) = delete;
  LcmLink& operator=(const LcmLink&) = delete;

  const LcmUrl& url() const { return url_; }

  /// Receives the channels that match a regular expression. `handler` is called
  /// from Handle, with `user`. liblcm holds at most `queue_capacity` messages.
  /// Errors: a bus that does not carry what is sent.
  Status Subscribe(const std::string& channel, Handler handler, void* user,
                   int queue_capacity);

  /// Returns false when the message could not be sent. A hub that takes nothing
  /// delays this by kSendPatience, once.
  bool Publish(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// Readable when there is something for Handle. The same for the life of the
  /// link, once there is a subscription or the bus is a tcpq:// one.
  int fd() const;
  /// Takes one message, or sees to a hub that went away or came back. Returns
  /// false when nothing will come any more, which is said: a file:// bus was
  /// played to its end. (Its descriptor stays readable for ever.)
  bool Handle();

 private:
  struct Subscription {
    std::string channel;
    Handler handler;
    void* user;
    int queue_capacity;
  };

  explicit LcmLink(LcmUrl url) : url_(std::move(url)) {}
  Status OpenTcpq();
  bool SubscribeTo(const Subscription& subscription);
  void HandleTcpq();
  void Connect();
  void Drop();
  bool HasEnded() const;
  bool HasMessage() const;
  void LookAgainIn(std::int64_t milliseconds) const;

  const LcmUrl url_;
  mutable std::mutex mutex_;  // For all below.
  std::vector<Subscription> subscriptions_;
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

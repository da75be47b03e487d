#include "bus/lcm_link.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>

#include "bus/bus.h"
#include "bus/log.h"

namespace terra::bus {
namespace {

// Between two looks for a hub that is away.
constexpr std::int64_t kRetryMs = 500;
// A hub on the network answers within this time, or is taken for away.
constexpr int kAnswerMs = 500;
// How long a publish waits for a hub that takes nothing.
constexpr int kSendPatienceMs = 100;
constexpr std::string_view kEveryChannel = ".*";
// What a hub says first: its magic number and a version.
constexpr std::size_t kGreetingBytes = 8;

bool IsReadable(int fd, int wait_ms) {
  pollfd waited{fd, POLLIN, 0};
  return poll(&waited, 1, wait_ms) == 1;
}

std::string ErrnoText(int number) {
  return std::strerror(number);
}

// The hub's address in numbers: liblcm 1.3.1 looks up no names.
Result<sockaddr_in> HubAddress(const LcmUrl& url) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(
      url.host.c_str(), std::to_string(url.port).c_str(), &wanted, &found);
  if (failed != 0) return Error{ErrorCode::kUnavailable, gai_strerror(failed)};
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof address);
  freeaddrinfo(found);
  return address;
}

// Waits until a socket that connects has done so. Returns 0 or an errno.
int Connected(int fd) {
  pollfd waited{fd, POLLOUT, 0};
  if (poll(&waited, 1, kAnswerMs) != 1) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

// Returns 0 when the hub greets whoever connects, else an errno. liblcm waits
// without end for a greeting, so it is not let near a hub that gives none.
int Greets(const sockaddr_in& hub) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return errno;
  int error = 0;
  if (connect(fd, reinterpret_cast<const sockaddr*>(&hub), sizeof hub) != 0) {
    error = errno == EINPROGRESS ? Connected(fd) : errno;
  }
  for (std::size_t left = kGreetingBytes; error == 0 && left > 0;) {
    std::array<char, kGreetingBytes> greeting{};
    const bool answers = IsReadable(fd, kAnswerMs);
    const ssize_t got = answers ? recv(fd, greeting.data(), left, 0) : 0;
    if (got > 0) {
      left -= static_cast<std::size_t>(got);
    } else if (got < 0) {
      error = errno;
    } else {
      error = answers ? ECONNRESET : ETIMEDOUT;
    }
  }
  close(fd);
  return error;
}

// How long liblcm waits in the middle of a message.
void SetPatience(int fd, int option, int milliseconds) {
  const timeval patience = {0, 1'000L * milliseconds};
  setsockopt(fd, SOL_SOCKET, option, &patience, sizeof patience);
}

// What liblcm received goes to whoever subscribed.
template <typename Subscription>
void OnLcmMessage(const lcm_recv_buf_t* buffer, const char* channel,
                  void* subscription) noexcept {
  const auto& one = *static_cast<const Subscription*>(subscription);
  one.handler(
      channel,
      {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
      one.user);
}

// Sends what liblcm would send itself, until it comes back.
bool ComesBack(lcm_t* out, UdpmReceiver& receiver) {
  constexpr int kTries = 10;
  constexpr auto kWait = std::chrono::milliseconds(100);
  constexpr char kText[] = "lcm self test";
  bool heard = false;
  for (int i = 0; i < kTries && !heard; ++i) {
    lcm_publish(out, kSelfTestChannel, kText, sizeof kText);
    const auto until = std::chrono::steady_clock::now() + kWait;
    while (!heard) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(
          until - std::chrono::steady_clock::now());
      if (left.count() <= 0) break;
      if (!IsReadable(receiver.fd(), static_cast<int>(left.count()))) break;
      receiver.Drain(LcmLink::kMessagesPerHandle,
                     [&heard](const LcmDatagram& datagram, SenderAddress) {
                       heard = heard || datagram.channel == kSelfTestChannel;
                     });
    }
  }
  return heard;
}

bool EndsNow(int fd) {
  char byte = 0;
  const ssize_t got = recv(fd, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return got == 0 ||
         (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

void Add(int epoll_fd, int fd) {
  epoll_event event{};
  event.events = EPOLLIN;
  epoll_ctl(epoll_fd, EPOLL_CTL_ADD, fd, &event);
}

}  // namespace

Result<std::unique_ptr<LcmLink>> LcmLink::Open(const std::string& url,
                                               Use use) {
  Result<LcmUrl> parsed = ParseLcmUrl(url);
  if (!parsed) return parsed.error();
  std::unique_ptr<LcmLink> link(new LcmLink(*std::move(parsed), use));
  if (link->url_.is_tcpq()) {
    const Status opened = link->OpenTcpq();
    if (!opened) return opened.error();
    return link;
  }
  const std::string text = link->url_.text();
  link->in_ = link->out_ = lcm_create(text.c_str());
  if (link->in_ == nullptr) return DiagnoseBus(text, "LCM refuses it");
  return link;
}

Status LcmLink::OpenTcpq() {
  epoll_fd_ = epoll_create1(EPOLL_CLOEXEC);
  timer_fd_ = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  if (epoll_fd_ < 0 || timer_fd_ < 0) {
    return Error{ErrorCode::kUnavailable,
                 "cannot wait for " + url_.text() + ": " + ErrnoText(errno)};
  }
  Add(epoll_fd_, timer_fd_);
  Connect();
  return Done{};
}

LcmLink::~LcmLink() {
  if (out_ != nullptr && out_ != in_) lcm_destroy(out_);
  if (in_ != nullptr) lcm_destroy(in_);
  if (timer_fd_ >= 0) close(timer_fd_);
  if (epoll_fd_ >= 0) close(epoll_fd_);
}

int LcmLink::fd() const {
  if (url_.is_tcpq()) return epoll_fd_;
  if (url_.is_udpm()) return receiver_ ? receiver_->fd() : -1;
  return lcm_get_fileno(in_);
}

// liblcm opens its own receiving socket with its first subscription; it gets
// none.
Status LcmLink::OpenReceiver() {
  Result<UdpmReceiver> opened = UdpmReceiver::Open(url_.text());
  if (!opened) return DiagnoseBus(url_.text(), opened.error().message);
  if (use_ == Use::kSendAndHear && !ComesBack(out_, *opened)) {
    return DiagnoseBus(url_.text(),
                       "what is sent does not come back (a firewall?)");
  }
  receiver_.emplace(*std::move(opened));
  return Done{};
}

bool LcmLink::SubscribeTo(Subscription& subscription) {
  lcm_subscription_t* subscribed =
      lcm_subscribe(in_, subscription.channel.c_str(),
                    &OnLcmMessage<Subscription>, &subscription);
  if (subscribed == nullptr) return false;
  lcm_subscription_set_queue_capacity(subscribed, subscription.queue_capacity);
  return true;
}

Status LcmLink::Subscribe(const std::string& channel, Handler handler,
                          void* user, int queue_capacity) {
  const std::lock_guard lock(mutex_);
  subscriptions_.push_back({channel, handler, user, queue_capacity});
  if (url_.is_tcpq()) {
    if (in_ != nullptr) SubscribeTo(subscriptions_.back());
    return Done{};
  }
  if (url_.is_udpm()) return receiver_ ? Status(Done{}) : OpenReceiver();
  if (!SubscribeTo(subscriptions_.back()) || lcm_get_fileno(in_) < 0) {
    return DiagnoseBus(url_.text(),
                       "what is sent does not come back (a firewall?)");
  }
  return Done{};
}

bool LcmLink::Publish(const std::string& channel,
                      std::span<const std::uint8_t> bytes) {
  if (use_ == Use::kHear) return false;
  const auto send = [&] {
    return lcm_publish(out_, channel.c_str(), bytes.data(),
                       static_cast<unsigned>(bytes.size())) == 0;
  };
  if (!url_.is_tcpq()) return send();
  const std::lock_guard lock(mutex_);
  if (out_ == nullptr || failed_) return false;
  if (send()) return true;
  failed_ = true;
  LookAgainIn(0);
  return false;
}

bool LcmLink::Handle() {
  if (url_.is_tcpq()) {
    HandleTcpq();
    return true;
  }
  if (url_.is_udpm()) {
    HandleUdpm();
    return true;
  }
  const bool at_end = lcm_handle(in_) != 0 && url_.provider == "file";
  if (at_end) LogInfo(url_.text() + " was played to its end");
  return !at_end;
}

void LcmLink::HandleUdpm() {
  const std::lock_guard lock(mutex_);
  receiver_->Drain(
      kMessagesPerHandle, [this](const LcmDatagram& datagram, SenderAddress) {
        for (const Subscription& one : subscriptions_) {
          if (one.channel == kEveryChannel || one.channel == datagram.channel) {
            one.handler(datagram.channel, datagram.payload, one.user);
          }
        }
      });
}

UdpmReceiver::Counters LcmLink::counters() const {
  const std::lock_guard lock(mutex_);
  return receiver_ ? receiver_->counters() : UdpmReceiver::Counters{};
}

// The messages of in_ are handled outside the lock: nobody else reads there,
// and Publish must not wait for one that comes in pieces.
void LcmLink::HandleTcpq() {
  {
    const std::lock_guard lock(mutex_);
    std::uint64_t times = 0;
    const bool time_to_look = read(timer_fd_, &times, sizeof times) > 0;
    if (in_ == nullptr) {
      if (!time_to_look) return;
    } else if (HasEnded()) {
      Drop();
      return;
    } else if (!HasMessage()) {
      return;
    }
  }
  if (in_ == nullptr) {
    Connect();
  } else if (lcm_handle(in_) != 0) {
    const std::lock_guard lock(mutex_);
    Drop();
  }
}

bool LcmLink::HasEnded() const {
  return failed_ || EndsNow(lcm_get_fileno(in_)) ||
         EndsNow(lcm_get_fileno(out_));
}

bool LcmLink::HasMessage() const {
  return IsReadable(lcm_get_fileno(in_), 0);
}

// Looks for the hub without the lock, so that Publish does not wait for it.
void LcmLink::Connect() {
  const Result<sockaddr_in> hub = HubAddress(url_);
  std::string trouble = hub ? "" : hub.error().message;
  lcm_t* in = nullptr;
  lcm_t* out = nullptr;
  if (hub) {
    if (const int error = Greets(*hub); error != 0) trouble = ErrnoText(error);
  }
  if (trouble.empty()) {
    std::array<char, INET_ADDRSTRLEN> host{};
    inet_ntop(AF_INET, &hub->sin_addr, host.data(), host.size());
    LcmUrl numeric = url_;
    numeric.host = host.data();
    in = lcm_create(numeric.text().c_str());
    out = lcm_create(numeric.text().c_str());
  }
  const std::lock_guard lock(mutex_);
  in_ = in;
  out_ = out;
  if (in_ == nullptr || out_ == nullptr || lcm_get_fileno(in_) < 0 ||
      lcm_get_fileno(out_) < 0) {
    if (trouble.empty()) trouble = "it went away at once";
    if (!away_) {
      LogWarning("no hub answers at " + url_.text() + " (" + trouble +
                 "): nothing is sent or heard until one does; it is looked "
                 "for twice a second");
    }
    away_ = true;
    Drop();
    return;
  }
  SetPatience(lcm_get_fileno(out_), SO_SNDTIMEO, kSendPatienceMs);
  SetPatience(lcm_get_fileno(in_), SO_RCVTIMEO, kAnswerMs);
  for (Subscription& each : subscriptions_) SubscribeTo(each);
  Add(epoll_fd_, lcm_get_fileno(in_));
  Add(epoll_fd_, lcm_get_fileno(out_));
  if (away_) LogInfo("the hub at " + url_.text() + " is back");
  away_ = false;
}

// Closing a socket takes it out of the epoll set.
void LcmLink::Drop() {
  if (!away_) {
    LogWarning("the hub at " + url_.text() +
               " went away: nothing is sent or heard until it returns; it is "
               "looked for twice a second");
  }
  away_ = true;
  failed_ = false;
  if (in_ != nullptr) lcm_destroy(std::exchange(in_, nullptr));
  if (out_ != nullptr) lcm_destroy(std::exchange(out_, nullptr));
  LookAgainIn(kRetryMs);
}

void LcmLink::LookAgainIn(std::int64_t milliseconds) const {
  // Zero would stop the timer.
  const itimerspec when = {
      {}, {milliseconds / 1'000, milliseconds % 1'000 * 1'000'000 + 1}};
  timerfd_settime(timer_fd_, 0, &when, nullptr);
}

}  // namespace terra::bus

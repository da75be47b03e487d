#include "bus/bus.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/select.h>
#include <sys/socket.h>

#include "bus/lcm_url.h"

namespace terra::bus {
namespace {

// liblcm's own queue in front of the receive thread; the thread empties it at
// once, so it only has to hold what comes while the thread is not scheduled.
constexpr int kLcmQueueCapacity = 1000;

sockaddr_in GroupAddress(const LcmUrl& url) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(url.port));
  inet_pton(AF_INET, url.group.c_str(), &address.sin_addr);
  return address;
}

// liblcm 1.3.1 waits with select(), which ends the process when a descriptor
// is FD_SETSIZE or more: refused here, with a word.
Status RoomForLcm() {
  constexpr int kDescriptorsOfLcm = 24;
  const int next = eventfd(0, EFD_CLOEXEC);
  if (next >= 0) close(next);
  if (next >= 0 && next + kDescriptorsOfLcm < FD_SETSIZE) return Done{};
  return Error{
      ErrorCode::kUnavailable,
      next < 0
          ? std::string("no file descriptor left: ") + std::strerror(errno)
          : "about " + std::to_string(next) +
                " file descriptors are open already and LCM cannot use those "
                "from " +
                std::to_string(FD_SETSIZE) +
                " on: close what the parent process leaves open"};
}

}  // namespace

Error WhyUnusable(const std::string& text, const std::string& what) {
  const Result<LcmUrl> url = ParseLcmUrl(text);
  if (!url) return url.error();
  std::string why = what;
  if (url->is_udpm()) {
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = GroupAddress(*url);
    const auto* generic = reinterpret_cast<const sockaddr*>(&address);
    if (connect(fd, generic, sizeof address) != 0) {
      why =
          "there is no route for multicast on this host. As root: ip link set "
          "lo up multicast on && ip route add 224.0.0.0/4 dev lo";
    } else {
      close(fd);
      const int other = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      const int on = 1;
      setsockopt(other, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
      address.sin_addr.s_addr = htonl(INADDR_ANY);
      if (bind(other, generic, sizeof address) != 0) {
        why = "UDP port " + std::to_string(url->port) +
              " is taken by another program (" + std::strerror(errno) +
              "); choose another port";
      }
      close(other);
      return Error{ErrorCode::kUnavailable,
                   "cannot use the bus " + text + ": " + why};
    }
    close(fd);
  }
  return Error{ErrorCode::kUnavailable,
               "cannot use the bus " + text + ": " + why};
}

Result<std::unique_ptr<Bus>> Bus::Open(const std::string& url,
                                       ChannelNames names) {
  const Result<LcmUrl> parsed = ParseLcmUrl(url);
  if (!parsed) return parsed.error();
  if (const Status room = RoomForLcm(); !room) return room.error();
  lcm_t* lcm = lcm_create(url.c_str());
  if (lcm == nullptr) return WhyUnusable(url, "LCM refuses it");
  return std::unique_ptr<Bus>(new Bus(url, std::move(names), lcm));
}

Bus::Bus(std::string url, ChannelNames names, lcm_t* lcm)
    : url_(std::move(url)), names_(std::move(names)), lcm_(lcm) {}

Bus::~Bus() {
  if (receiver_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t n = write(stop_fd_, &one, sizeof one);
    receiver_.join();
  }
  if (stop_fd_ >= 0) close(stop_fd_);
  lcm_destroy(lcm_);
}

Status Bus::Listen(std::span<const Channel> channels, Inbox& inbox) {
  TERRA_REQUIRE(inbox_ == nullptr);
  inbox_ = &inbox;
  for (const Channel channel : channels) {
    subscriptions_.push_back(
        std::make_unique<Subscription>(Subscription{this, channel}));
    lcm_subscription_t* subscribed =
        lcm_subscribe(lcm_, names_.name(channel).c_str(), &Bus::OnMessage,
                      subscriptions_.back().get());
    // The first subscription opens the receiving socket and sends itself a
    // test message; where that fails there is no descriptor to wait on.
    if (subscribed == nullptr || lcm_get_fileno(lcm_) < 0) {
      return WhyUnusable(url_, "what is sent does not come back (a firewall?)");
    }
    lcm_subscription_set_queue_capacity(subscribed, kLcmQueueCapacity);
  }
  stop_fd_ = eventfd(0, EFD_CLOEXEC);
  if (stop_fd_ < 0) {
    return Error{ErrorCode::kUnavailable,
                 std::string("eventfd: ") + std::strerror(errno)};
  }
  receiver_ = std::thread([this] {
    Receive();
  });
  return Done{};
}

bool Bus::Publish(Channel channel, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxMessageBytes ||
      lcm_publish(lcm_, names_.name(channel).c_str(), bytes.data(),
                  static_cast<unsigned>(bytes.size())) != 0) {
    ++counters_.send_failed;
    return false;
  }
  ++counters_.sent;
  return true;
}

void Bus::OnMessage(const lcm_recv_buf_t* buffer, const char*,
                    void* subscription) noexcept {
  const auto& [bus, channel] = *static_cast<Subscription*>(subscription);
  // A datagram without an end of its channel name shows as a huge size.
  if (buffer->data_size > kMaxMessageBytes) {
    ++bus->counters_.oversized;
    return;
  }
  ++bus->counters_.received;
  bus->inbox_->Push(channel, {static_cast<const std::uint8_t*>(buffer->data),
                              buffer->data_size});
}

// THREADING: the one thread that handles this LCM object. It waits for liblcm's
// own read thread (which empties the socket) and for the stop event, and only
// copies messages into the inbox, so it never falls behind.
void Bus::Receive() {
  std::array<pollfd, 2> waited = {pollfd{lcm_get_fileno(lcm_), POLLIN, 0},
                                  pollfd{stop_fd_, POLLIN, 0}};
  while (true) {
    if (poll(waited.data(), waited.size(), -1) < 0) continue;  // EINTR
    if (waited[1].revents != 0) return;
    if (waited[0].revents != 0) lcm_handle(lcm_);
  }
}

}  // namespace terra::bus

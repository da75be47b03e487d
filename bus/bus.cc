#include "bus/bus.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

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
  address.sin_addr.s_addr = htonl(url.address);
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

Error DiagnoseBus(const std::string& text, const std::string& what) {
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
                                       ChannelNames names, Use use) {
  if (const Status room = RoomForLcm(); !room) return room.error();
  Result<std::unique_ptr<LcmLink>> link = LcmLink::Open(url, use);
  if (!link) return link.error();
  std::unique_ptr<Bus> bus(new Bus(*std::move(link), std::move(names)));
  if (bus->link_->url().is_tcpq()) {
    // Whether the hub is there is seen by whoever waits for what it sends.
    const Status started = bus->StartReceiving();
    if (!started) return started.error();
  }
  return bus;
}

Bus::Bus(std::unique_ptr<LcmLink> link, ChannelNames names)
    : link_(std::move(link)),
      url_(link_->url().text()),
      names_(std::move(names)) {}

Bus::~Bus() {
  if (receiver_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t n = write(stop_fd_, &one, sizeof one);
    receiver_.join();
  }
  if (stop_fd_ >= 0) close(stop_fd_);
}

Status Bus::Listen(std::span<const Channel> channels, Inbox& inbox) {
  TERRA_REQUIRE(inbox_ == nullptr);
  inbox_ = &inbox;
  for (const Channel channel : channels) {
    subscriptions_.push_back(
        std::make_unique<Subscription>(Subscription{this, channel}));
    const Status subscribed =
        link_->Subscribe(names_.name(channel), &Bus::OnMessage,
                         subscriptions_.back().get(), kLcmQueueCapacity);
    if (!subscribed) return subscribed.error();
  }
  return receiver_.joinable() ? Status(Done{}) : StartReceiving();
}

Status Bus::StartReceiving() {
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
      !link_->Publish(names_.name(channel), bytes)) {
    ++counters_.send_failed;
    return false;
  }
  ++counters_.sent;
  return true;
}

void Bus::OnMessage(std::string_view, std::span<const std::uint8_t> bytes,
                    void* subscription) noexcept {
  const auto& [bus, channel] = *static_cast<Subscription*>(subscription);
  if (bytes.size() > kMaxMessageBytes) {
    ++bus->counters_.oversized;
    return;
  }
  ++bus->counters_.received;
  bus->inbox_->Push(channel, bytes);
}

void Bus::CountDatagrams() {
  const UdpmReceiver::Counters read = link_->counters();
  counters_.fragments = static_cast<std::int64_t>(read.fragments);
  counters_.no_message = static_cast<std::int64_t>(read.malformed);
  counters_.lost_in_kernel = static_cast<std::int64_t>(read.lost_in_kernel);
}

// THREADING: the one thread that handles this link. It waits for the socket
// (where liblcm reads, for liblcm's own read thread) and for the stop event,
// and only copies messages into the inbox, so it never falls behind.
void Bus::Receive() {
  std::array<pollfd, 2> waited = {pollfd{link_->fd(), POLLIN, 0},
                                  pollfd{stop_fd_, POLLIN, 0}};
  while (true) {
    if (poll(waited.data(), waited.size(), -1) < 0) continue;  // EINTR
    if (waited[1].revents != 0) return;
    if (waited[0].revents == 0) continue;
    if (!link_->Handle()) waited[0].fd = -1;
    CountDatagrams();
  }
}

}  // namespace terra::bus

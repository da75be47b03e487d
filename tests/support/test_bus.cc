#include "tests/support/test_bus.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace terra::testing {
namespace {

// Makes loopback usable in a new network namespace: up, with a route for
// multicast.
bool OpenLoopback() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  ifreq loopback{};
  std::copy_n("lo", 3, loopback.ifr_name);
  loopback.ifr_flags = IFF_UP | IFF_RUNNING | IFF_MULTICAST | IFF_LOOPBACK;
  bool ok = ::ioctl(fd, SIOCSIFFLAGS, &loopback) == 0;
  rtentry route{};
  auto address = [](std::uint32_t host_order) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_addr.s_addr = htonl(host_order);
    sockaddr out{};
    static_assert(sizeof in == sizeof out);
    std::copy_n(reinterpret_cast<const char*>(&in), sizeof in,
                reinterpret_cast<char*>(&out));
    return out;
  };
  std::array<char, 3> device = {'l', 'o', '\0'};
  route.rt_dst = address(0xE0000000);      // 224.0.0.0
  route.rt_genmask = address(0xF0000000);  // /4
  route.rt_flags = RTF_UP;
  route.rt_dev = device.data();
  ok = ok && ::ioctl(fd, SIOCADDRT, &route) == 0;
  ::close(fd);
  return ok;
}

// Before the test has other threads: a namespace is a thread's.
bool EnterOwnNamespace() {
  static const bool entered = [] {
    if (::unshare(CLONE_NEWNET) != 0) return false;
    if (!OpenLoopback()) throw std::runtime_error("no loopback in a namespace");
    return true;
  }();
  return entered;
}

// Returns a locked file descriptor, -1 when another test has these ports.
int LockPorts(int port) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("terra-test-ports-" + std::to_string(port));
  const int fd = ::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  ::close(fd);
  return -1;
}

std::string UrlOf(int port) {
  return "udpm://239.255.76.67:" + std::to_string(port) +
         "?ttl=0&recv_buf_size=2097152";
}

std::unique_ptr<bus::Bus> OpenBus(const std::string& url,
                                  const std::string& robot) {
  auto opened =
      bus::Bus::Open(url, bus::ChannelNames::Create(robot, robot).value());
  if (!opened) throw std::runtime_error(opened.error().message);
  return *std::move(opened);
}

}  // namespace

TestBus::TestBus() : in_own_namespace_(EnterOwnNamespace()) {
  constexpr int kFirstPort = 30000;
  constexpr int kStep = 3;  // deployed bus, advice, journal
  constexpr int kBuses = 1300;
  for (int i = 0; i < kBuses && lock_fd_ < 0; ++i) {
    port_ = kFirstPort + kStep * ((::getpid() + i) % kBuses);
    lock_fd_ = LockPorts(port_);
  }
  if (lock_fd_ < 0) throw std::runtime_error("no free test ports");
  url_ = UrlOf(port_);
  advice_url_ = UrlOf(port_ + 1);
}

TestBus::~TestBus() {
  ::close(lock_fd_);
}

BusPeer::BusPeer(const std::string& url, const std::string& robot)
    : bus_(OpenBus(url, robot)), out_(*bus_, bus::RandomId()) {
  std::vector<bus::Channel> all;
  for (int i = 0; i < bus::kNumChannels; ++i) {
    all.push_back(static_cast<bus::Channel>(i));
  }
  const Status listening = bus_->Listen(all, inbox_);
  if (!listening) throw std::runtime_error(listening.error().message);
}

bool BusPeer::Hear(bus::Time until) {
  const std::size_t before = heard_.size();
  while (true) {
    inbox_.Clear();
    while (auto message = inbox_.Pop()) heard_.push_back(std::move(*message));
    if (heard_.size() > before) return true;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(until - bus::Clock::now());
    if (left.count() <= 0) return false;
    pollfd readable{inbox_.fd(), POLLIN, 0};
    ::poll(&readable, 1, static_cast<int>(left.count()));
  }
}

void BusPeer::Forget() {
  Hear(bus::Clock::now());
  heard_.clear();
}

}  // namespace terra::testing

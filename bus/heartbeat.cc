#include "bus/heartbeat.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <sys/socket.h>
#include <sys/un.h>

#include "bus/build_id.h"
#include "bus/log.h"

namespace terra::bus {
namespace {

constexpr Duration kShortestPeriod = std::chrono::milliseconds(100);

std::string HostName() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

}  // namespace

Heartbeat::Heartbeat(std::string name, std::string config, Outbox& out,
                     const Bus& sends, const Bus& hears, const Inbox& inbox)
    : name_(std::move(name)),
      config_(std::move(config)),
      host_(HostName()),
      out_(out),
      sends_(sends),
      hears_(hears),
      inbox_(inbox) {}

Time Heartbeat::Advance(const Node& node, Time now) {
  const bool changed = node.state() != sent_state_;
  if (due_.Due(now) || (changed && now >= earliest_)) {
    sent_state_ = node.state();
    SendStatus(node);
    due_.Postpone(now);
    earliest_ = now + kShortestPeriod;
    return due_.next();
  }
  return changed ? earliest_ : due_.next();
}

void Heartbeat::SendStatus(const Node& node) {
  terra_msg::status_t status{};
  status.status_name = name_;
  status.host = host_;
  status.pid = static_cast<std::int32_t>(getpid());
  status.state = node.state();
  status.build_id = BuildId();
  status.last_error = node.last_error();
  Counters counters;
  counters.emplace_back("sent", sends_.counters().sent);
  counters.emplace_back("send_failed", sends_.counters().send_failed);
  counters.emplace_back("oversized", hears_.counters().oversized);
  counters.emplace_back("fragments", hears_.counters().fragments);
  counters.emplace_back("no_message", hears_.counters().no_message);
  counters.emplace_back("lost_in_kernel", hears_.counters().lost_in_kernel);
  counters.emplace_back("queue_dropped", inbox_.dropped());
  counters.emplace_back("log_dropped", LogLinesDropped());
  node.AddCounters(counters);
  status.num_counters = static_cast<std::int32_t>(counters.size());
  for (const auto& [counter, value] : counters) {
    status.counter_name.push_back(counter);
    status.counter_value.push_back(value);
  }
  out_.Send(status);  // And cleans what is logged below.

  if (status.state != logged_state_) LogInfo(status.state);
  if (status.last_error != logged_error_ && !status.last_error.empty()) {
    LogWarning(status.last_error);
  }
  logged_state_ = status.state;
  logged_error_ = status.last_error;
  NotifyServiceManager((node.works() ? "WATCHDOG=1\nSTATUS=" : "STATUS=") +
                       status.state);
}

void Heartbeat::SendConfig() {
  terra_msg::config_t config{};
  config.config_name = name_;
  config.build_id = BuildId();
  config.config_text = config_;
  out_.Send(config);
}

void NotifyServiceManager(const std::string& line) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path == nullptr || *path == '\0' ||
      std::strlen(path) >= sizeof address.sun_path) {
    return;
  }
  std::memcpy(address.sun_path, path, std::strlen(path));
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';  // abstract
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return;
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) +
                                             std::strlen(path));
  sendto(fd, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
         reinterpret_cast<const sockaddr*>(&address), length);
  close(fd);
}

}  // namespace terra::bus

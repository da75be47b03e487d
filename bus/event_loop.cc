#include "bus/event_loop.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include <sys/signalfd.h>

namespace terra::bus {
namespace {

// A turn hands over this many messages at most, so that timers run and stop
// signals are seen also when messages come faster than they are handled.
constexpr int kMessagesPerTurn = 1000;

timespec ToTimespec(Duration wait) {
  const auto ns =
      std::chrono::duration_cast<std::chrono::nanoseconds>(wait).count();
  return timespec{static_cast<time_t>(ns / 1'000'000'000),
                  static_cast<long>(ns % 1'000'000'000)};
}

// Waits until a descriptor is readable or the time has come.
void Wait(std::vector<pollfd>& fds, Time until) {
  timespec wait{};
  if (until != kNever) {
    // Compared first: a time of "at once" may be too long ago to subtract from.
    const Time now = Clock::now();
    wait = ToTimespec(until > now ? until - now : Duration::zero());
  }
  const int ready =
      ppoll(fds.data(), fds.size(), until == kNever ? nullptr : &wait, nullptr);
  if (ready >= 0) return;
  if (errno != EINTR) {
    throw std::system_error(errno, std::generic_category(), "poll");
  }
  for (pollfd& fd : fds) fd.revents = 0;
}

}  // namespace

StopSignal::StopSignal() {
  std::signal(SIGPIPE, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  if (fd_ < 0) {
    throw std::system_error(errno, std::generic_category(), "signalfd");
  }
}

StopSignal::~StopSignal() {
  close(fd_);
}

void EventLoop::Watch(int fd, Handler handle) {
  watched_.push_back(Watched{fd, std::move(handle)});
}

void EventLoop::Every(Duration period, Handler handle) {
  timers_.push_back(Timer{Periodic(period), std::move(handle)});
}

void EventLoop::AfterTurn(std::function<Time(Time)> look) {
  after_turn_.push_back(std::move(look));
}

Time EventLoop::RunTimers(Time now) {
  Time next = kNever;
  for (Timer& timer : timers_) {
    if (timer.period.Due(now)) timer.handle(now);
    next = std::min(next, timer.period.next());
  }
  for (const auto& look : after_turn_) next = std::min(next, look(now));
  return next;
}

void EventLoop::Run(Node& node) {
  std::vector<pollfd> fds = {pollfd{stop_.fd(), POLLIN, 0},
                             pollfd{inbox_.fd(), POLLIN, 0}};
  const std::size_t num_own = fds.size();
  for (const Watched& watched : watched_) {
    fds.push_back(pollfd{watched.fd, POLLIN, 0});
  }
  Time next = Time::min();
  while (true) {
    Wait(fds, next);
    if (fds[0].revents != 0) return;
    inbox_.Clear();
    int messages = 0;
    while (messages < kMessagesPerTurn) {
      const std::optional<RawMessage> message = inbox_.Pop();
      if (!message) break;
      node.Receive(*message, Clock::now());
      ++messages;
    }
    for (std::size_t i = 0; i < watched_.size(); ++i) {
      if (fds[num_own + i].revents != 0) watched_[i].handle(Clock::now());
    }
    const Time now = Clock::now();
    next = std::min(node.Advance(now), RunTimers(now));
    if (node.done()) return;
    if (messages == kMessagesPerTurn) next = now;  // there may be more
  }
}

}  // namespace terra::bus

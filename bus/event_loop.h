#pragma once

#include <functional>
#include <vector>

#include "bus/inbox.h"
#include "bus/node.h"
#include "bus/time.h"

namespace terra::bus {

/// Turns SIGINT and SIGTERM into a readable descriptor.
///
/// Blocks both for the calling thread and all it starts later, so make it
/// before anything else; SIGPIPE is ignored.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  int fd() const { return fd_; }

 private:
  int fd_ = -1;
};

/// Drives one node: waits for messages, descriptors and timers, without ever
/// polling in vain.
///
/// Each turn hands over all messages of the inbox, then looks at the watched
/// descriptors, then lets the node advance. So the deployed bus comes before
/// whatever is watched.
/// Threads: Run in one thread; the inbox's Wake ends a wait from any other.
class EventLoop {
 public:
  using Handler = std::function<void(Time)>;

  EventLoop(Inbox& inbox, const StopSignal& stop)
      : inbox_(inbox), stop_(stop) {}

  /// Calls `handle` while `fd` is readable, at most once a turn.
  void Watch(int fd, Handler handle);

  /// Calls `handle` at once and then once a period.
  void Every(Duration period, Handler handle);

  /// Calls `look` after the node in every turn; it returns when it wants the
  /// next turn at the latest.
  void AfterTurn(std::function<Time(Time)> look);

  /// Returns when a stop signal came or the node is done.
  void Run(Node& node);

 private:
  struct Watched {
    int fd;
    Handler handle;
  };
  struct Timer {
    Periodic period;
    Handler handle;
  };

  Time RunTimers(Time now);

  Inbox& inbox_;
  const StopSignal& stop_;
  std::vector<Watched> watched_;
  std::vector<Timer> timers_;
  std::vector<std::function<Time(Time)>> after_turn_;
};

}  // namespace terra::bus

#pragma once

#include <string>

#include "bus/bus.h"
#include "bus/envelope.h"
#include "bus/node.h"
#include "bus/time.h"

namespace terra::bus {

/// Tells bus, log and service manager how a process is.
class Heartbeat {
 public:
  /// `config` is what --print-config prints; `out` sends on the bus `sends`,
  /// and the process hears the bus `hears`.
  Heartbeat(std::string name, std::string config, Outbox& out, const Bus& sends,
            const Bus& hears, const Inbox& inbox);

  /// Sends STATUS where it is due: when a second has passed since the last, and
  /// when the state changed (at most ten a second, however it flutters).
  /// Returns when to call at the latest; call also after every turn of the
  /// node.
  ///
  /// Logs a state or error that changed; feeds the watchdog of systemd where
  /// there is one (sd_notify(3) protocol).
  Time Advance(const Node& node, Time now);
  void SendConfig();

 private:
  void SendStatus(const Node& node);

  std::string name_;
  std::string config_;
  std::string host_;
  Outbox& out_;
  const Bus& sends_;
  const Bus& hears_;
  const Inbox& inbox_;
  Periodic due_{kSlowPeriod};
  Time earliest_ = Time::min();  ///< Of the next STATUS.
  std::string sent_state_;
  std::string logged_state_;
  std::string logged_error_;
};

/// Sends one sd_notify(3) line, as "READY=1"; nothing where there is no
/// NOTIFY_SOCKET.
void NotifyServiceManager(const std::string& line);

}  // namespace terra::bus

#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "bus/node.h"
#include "bus/time.h"

namespace terra::cli {

/// What is known of a running set, from its messages: the route in force, the
/// latest verdicts, and every process with its age.
///
/// Shows it as text once a second through `show`, and ends when that cannot be
/// shown. Says nothing on the bus.
class MonitorNode : public bus::Node {
 public:
  /// Returns whether the text could be shown.
  using Show = std::function<bool(const std::string&)>;

  /// Ends after `duration`; kNever - now = never.
  MonitorNode(bus::Duration duration, Show show);

  bus::Time Advance(bus::Time now) override;
  std::string state() const override { return "watching"; }
  bool done() const override { return done_; }

  /// The view as lines of text.
  std::string View(bus::Time now) const;

 private:
  struct Process {
    terra_msg::status_t status;
    bus::Time heard_at;
  };

  void OnStatus(const terra_msg::status_t& message, bus::Time now);
  void OnVerdict(const terra_msg::verdict_t& message);
  std::string RouteLines(bus::Time now) const;
  std::string VerdictLines() const;
  std::string EarlierVerdictLines() const;
  std::string ProcessLines(bus::Time now) const;

  bus::Duration duration_;
  Show show_;
  bus::Time end_ = bus::kNever;
  bool started_ = false;
  bool done_ = false;
  bus::Periodic refresh_{bus::kSlowPeriod};
  std::map<std::string, Process> processes_;   // By name and host.
  std::deque<terra_msg::verdict_t> verdicts_;  // Newest first.
  std::optional<terra_msg::map_header_t> map_;
  std::optional<terra_msg::deployed_t> deployed_;
  bus::Time deployed_at_ = bus::kNever;
};

}  // namespace terra::cli

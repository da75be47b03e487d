#pragma once

#include <memory>
#include <string>

#include "bus/map_receiver.h"
#include "bus/node.h"
#include "logger/bus_tap.h"
#include "logger/event_queue.h"
#include "logger/recorder.h"

namespace terra::logger {

/// The recorder on the bus: what a BusTap hears goes to a Recorder, which is
/// flushed every kFlushPeriod, so that an event is on the disk 100 ms after it
/// was heard unless the disk itself takes longer.
///
/// It publishes no more than its heartbeat and MAP_REQUEST: a recording that
/// begins while the map is long known to all would otherwise lack it.
class LoggerNode : public bus::Node {
 public:
  static constexpr bus::Duration kFlushPeriod = std::chrono::milliseconds(40);

  LoggerNode(Recorder recorder, bus::ChannelNames channels, bus::Outbox& out);

  /// Begins to hear. Errors: as BusTap::Open.
  Status Listen(const BusTap::Urls& urls);
  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  std::string last_error() const override { return last_error_; }
  void AddCounters(bus::Counters& counters) const override;

  /// Writes what is still in the queue and ends the recording.
  void Finish() override;
  /// 1 when anything was lost or is not on the disk.
  int exit_code() const override;

 private:
  void TakeQueue();
  void Note(const Status& written);
  void FeedMap(const HeardEvent& event);

  Recorder recorder_;
  bus::ChannelNames channels_;
  EventQueue queue_;  // Outlives the tap's thread.
  std::unique_ptr<BusTap> tap_;
  bus::MapReceiver map_;
  bus::Periodic flush_{kFlushPeriod};
  bool failing_ = false;
  std::string last_error_;
};

}  // namespace terra::logger

#pragma once

#include <memory>
#include <string>

#include "bus/map_receiver.h"
#include "bus/node.h"
#include "logger/bus_tap.h"
#include "logger/disk_thread.h"
#include "logger/event_queue.h"
#include "logger/recorder.h"

namespace terra::logger {

/// The recorder on the bus: what a BusTap hears goes to a DiskThread every
/// kFlushPeriod, so that an event is on the disk 100 ms after it was heard
/// unless the disk itself takes longer. This thread never waits for the disk
/// until Finish.
///
/// It publishes no more than its heartbeat and MAP_REQUEST: a recording that
/// begins while the map is long known to all would otherwise lack it.
class LoggerNode : public bus::Node {
 public:
  static constexpr bus::Duration kFlushPeriod = std::chrono::milliseconds(40);
  /// A disk that takes nothing for longer is said to be failing.
  static constexpr bus::Duration kSlowDisk = std::chrono::seconds(1);
  /// How long the end waits for the disk.
  static constexpr bus::Duration kFinishWait = std::chrono::seconds(60);

  LoggerNode(Recorder recorder, bus::ChannelNames channels, bus::Outbox& out);

  /// Begins to hear. Errors: as BusTap::Open.
  Status Listen(const BusTap::Urls& urls);
  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  std::string last_error() const override { return last_error_; }
  bool works() const override;
  void AddCounters(bus::Counters& counters) const override;

  /// Writes what is still in the queue and ends the recording; waits for the
  /// disk for kFinishWait.
  void Finish() override;
  /// 1 when anything was lost or is not on the disk.
  int exit_code() const override;

 private:
  void TakeQueue();
  void NoteProgress(bus::Time now);
  void FeedMap(const HeardEvent& event);

  bus::ChannelNames channels_;
  DiskThread disk_;
  DiskThread::Progress progress_;  // As last seen.
  EventQueue queue_;               // Outlives the tap's thread.
  std::unique_ptr<BusTap> tap_;
  bus::MapReceiver map_;
  bus::Periodic flush_{kFlushPeriod};
  std::string failing_;  // Why; empty = it is not.
  bus::Time failed_{};   // When it was seen to fail last.
  bool finished_ = false;
  std::string last_error_;
};

}  // namespace terra::logger

#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "bus/time.h"
#include "logger/event_queue.h"
#include "logger/recorder.h"

namespace terra::logger {

/// Writes to a Recorder in a thread of its own, so that a disk that is slow or
/// does not answer holds up nobody else. What comes meanwhile waits in memory
/// (EventQueue::kMaxBytes); what does not fit is counted as lost.
///
/// Threads: one thread owns it; it starts the one that writes.
class DiskThread {
 public:
  /// How the recording is, after the last flush that has ended.
  struct Progress {
    bool failing = false;       ///< The last flush failed.
    std::int64_t failures = 0;  ///< Flushes that failed since the start.
    std::string error;          ///< Of the last one that failed.
    std::string path;           ///< Of the part that is being written.
    int part = 0;
    std::int64_t acknowledged = 0;
    std::int64_t pending_bytes = 0;
    std::int64_t lost = 0;
    std::int64_t deleted_parts = 0;
  };

  explicit DiskThread(Recorder recorder);
  /// Waits for the disk, unless Finish has given up.
  ~DiskThread();
  DiskThread(const DiskThread&) = delete;
  DiskThread& operator=(const DiskThread&) = delete;

  /// Takes over the events, and has all that waits put on the disk.
  void Write(EventQueue::Batch batch);

  Progress progress() const;
  /// For how long the flush that runs now has waited for the disk; 0 when none
  /// runs.
  bus::Duration WaitsForDisk(bus::Time now) const;
  /// The thread does its work or waits for the disk. False = it hangs, which
  /// only a restart mends.
  bool Works(bus::Time now) const;

  /// Writes all that waits and ends the recording. False when the disk has not
  /// taken it in this time; the thread is left alone then.
  bool Finish(bus::Duration at_most);

 private:
  // Belongs to both threads, so that the writing one may outlive this object
  // when the disk never answers.
  struct Shared {
    explicit Shared(Recorder started) : recorder(std::move(started)) {}

    Recorder recorder;  // Of the writing thread alone.
    EventQueue queue;
    mutable std::mutex mutex;  // Guards what follows.
    std::condition_variable changed;
    bool work = false;
    bool end = false;
    bool ended = false;
    bus::Time woken{};        // When the oldest work that is not done came.
    bus::Time flush_begun{};  // Zero = no flush runs.
    Progress progress;
  };

  static void Run(const std::shared_ptr<Shared>& shared);
  static void Turn(Shared& shared, bool last);

  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace terra::logger

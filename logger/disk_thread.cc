#include "logger/disk_thread.h"

#include <utility>

#include "bus/envelope.h"

namespace terra::logger {
namespace {

// Work that is not begun for so long is not for want of processor time.
constexpr bus::Duration kHangs = std::chrono::seconds(3);

void Update(DiskThread::Progress& progress, const Recorder& recorder,
            const Status& written) {
  progress.failing = !written;
  if (!written) {
    ++progress.failures;
    progress.error = written.error().message;
  }
  progress.path = recorder.path();
  progress.part = recorder.part();
  progress.acknowledged = recorder.acknowledged_events();
  progress.pending_bytes = recorder.pending_bytes();
  progress.lost = recorder.lost();
  progress.deleted_parts = recorder.deleted_parts();
}

}  // namespace

DiskThread::DiskThread(Recorder recorder)
    : shared_(std::make_shared<Shared>(std::move(recorder))) {
  Update(shared_->progress, shared_->recorder, Done{});
  thread_ = std::thread([shared = shared_] {
    Run(shared);
  });
}

DiskThread::~DiskThread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->end = true;
  }
  shared_->changed.notify_all();
  thread_.join();
}

void DiskThread::Write(EventQueue::Batch batch) {
  shared_->queue.Push(std::move(batch));
  {
    const std::lock_guard lock(shared_->mutex);
    if (!shared_->work) shared_->woken = bus::Clock::now();
    shared_->work = true;
  }
  shared_->changed.notify_all();
}

DiskThread::Progress DiskThread::progress() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->progress;
}

bus::Duration DiskThread::WaitsForDisk(bus::Time now) const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->flush_begun == bus::Time{} ? bus::Duration::zero()
                                             : now - shared_->flush_begun;
}

bool DiskThread::Works(bus::Time now) const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->flush_begun != bus::Time{} || !shared_->work ||
         now - shared_->woken < kHangs;
}

bool DiskThread::Finish(bus::Duration at_most) {
  std::unique_lock lock(shared_->mutex);
  shared_->end = true;
  shared_->changed.notify_all();
  const bool ended = shared_->changed.wait_for(lock, at_most, [this] {
    return shared_->ended;
  });
  lock.unlock();
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
  return ended;
}

void DiskThread::Run(const std::shared_ptr<Shared>& shared) {
  bool last = false;
  while (!last) {
    {
      std::unique_lock lock(shared->mutex);
      shared->changed.wait(lock, [&] {
        return shared->work || shared->end;
      });
      shared->work = false;
      shared->flush_begun = bus::Clock::now();
      last = shared->end;
    }
    Turn(*shared, last);
  }
}

// Takes all that waits, and puts it on the disk.
void DiskThread::Turn(Shared& shared, bool last) {
  Recorder& recorder = shared.recorder;
  const EventQueue::Batch batch = shared.queue.Take();
  for (const HeardEvent& event : batch.events) recorder.Record(event);
  if (batch.refused > 0) recorder.CountLost(batch.refused);
  const std::int64_t now_us = bus::UnixMicroseconds();
  const Status written = last ? recorder.Close(now_us) : recorder.Flush(now_us);
  const std::lock_guard lock(shared.mutex);
  Update(shared.progress, recorder, written);
  shared.flush_begun = {};
  shared.ended = last;
  if (last) shared.changed.notify_all();
}

}  // namespace terra::logger

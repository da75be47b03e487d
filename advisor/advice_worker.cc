#include "advisor/advice_worker.h"

#include <unistd.h>

#include <exception>
#include <utility>

#include <sys/resource.h>
#include <sys/syscall.h>

namespace terra::advisor {
namespace {

// The deployed path goes first where cores are few: measured on two, baselines
// waited 4 ms behind a search of normal priority.
void LowerOwnPriority() {
  constexpr int kNice = 10;
  // Without effect where it is refused; then the work is done all the same.
  static_cast<void>(::setpriority(
      PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), kNice));
}

}  // namespace

// THREADING: one worker thread runs Backend::Advise. It shares with the acting
// thread only the members under mutex_: one job waiting (a newer one takes its
// place), one answer. `current_` is replaced with every job, so a stop request
// reaches the job it was meant for and no other.
AdviceWorker::AdviceWorker(std::unique_ptr<Backend> backend,
                           std::function<void()> ready)
    : backend_(std::move(backend)),
      ready_(std::move(ready)),
      thread_([this](std::stop_token end) {
        LowerOwnPriority();
        Work(end);
      }) {}

void AdviceWorker::Start(Job job) {
  const std::lock_guard lock(mutex_);
  current_.request_stop();
  finished_.reset();
  waiting_ = std::move(job);
  changed_.notify_all();
}

void AdviceWorker::Cancel() {
  const std::lock_guard lock(mutex_);
  current_.request_stop();
  waiting_.reset();
  finished_.reset();
}

std::optional<AdviceWorker::Finished> AdviceWorker::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, std::nullopt);
}

bool AdviceWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_ || waiting_.has_value();
}

void AdviceWorker::Work(std::stop_token end) {
  // Ends a call that is still running when the process ends.
  const std::stop_callback stop_current(end, [this] {
    const std::lock_guard lock(mutex_);
    current_.request_stop();
  });
  while (!end.stop_requested()) {
    Job job;
    std::stop_token stop;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, end, [this] {
            return waiting_.has_value();
          })) {
        return;
      }
      job = *std::exchange(waiting_, std::nullopt);
      current_ = std::stop_source();
      stop = current_.get_token();
      busy_ = true;
    }
    AdviceAnswer answer;
    try {
      answer = backend_->Advise(
          AdviceTask{*job.map, job.map_id, job.request_id, job.anchor.cell,
                     job.goal, job.route, job.route_cost},
          stop);
    } catch (const std::exception& error) {
      answer = AdviceAnswer{};
      answer.error = error.what();
    }
    {
      const std::lock_guard lock(mutex_);
      busy_ = false;
      if (stop.stop_requested()) continue;
      finished_ = Finished{std::move(job), std::move(answer)};
    }
    ready_();
  }
}

}  // namespace terra::advisor

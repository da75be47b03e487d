#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "advisor/backend.h"
#include "bus/map_receiver.h"
#include "bus/node.h"

namespace terra::advisor {

/// Runs a backend in a thread of its own: the newest task only, and a new task
/// stops the one before.
///
/// Threads: Start, Cancel and Take from the thread that acts; `ready` is called
///          from the worker when an answer can be taken.
class AdviceWorker {
 public:
  /// A task with what keeps its map alive, and its number.
  struct Job {
    std::int64_t number = 0;
    bus::MapPtr map;
    terra_msg::baseline_t baseline;
    Route route;
    double baseline_cost = 0;
  };
  struct Done {
    Job job;
    AdviceAnswer answer;
  };

  AdviceWorker(std::unique_ptr<Backend> backend, std::function<void()> ready);

  void Start(Job job);
  void Cancel();
  std::optional<Done> Take();

  bool busy() const;
  const Backend& backend() const { return *backend_; }

 private:
  void Work(std::stop_token end);

  std::unique_ptr<Backend> backend_;
  std::function<void()> ready_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Job> waiting_;
  std::optional<Done> done_;
  bool busy_ = false;
  std::stop_source current_;
  std::jthread thread_;  // last: it uses the others
};

/// An advisor on the bus: listens to map and BASELINE; publishes ADVICE on the
/// advice bus when its backend has an answer, and then once a second while the
/// baseline stands. A newer baseline or map cancels the work for the old one.
class AdvisorNode : public bus::Node {
 public:
  /// `advice` sends on the advice bus, `out` on the deployed one.
  AdvisorNode(std::string name, std::unique_ptr<Backend> backend,
              bus::Outbox& out, bus::Outbox& advice,
              std::function<void()> wake);

  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  std::string last_error() const override;
  void AddCounters(bus::Counters& counters) const override;

 private:
  void OnBaseline(const terra_msg::baseline_t& message);
  void Begin();
  void Publish(const AdviceWorker::Done& done, bus::Time now);

  std::string name_;
  bus::Outbox& advice_;
  bus::MapReceiver map_;
  bus::SenderTracker planner_;
  terra_msg::baseline_t baseline_{};
  std::vector<terra_msg::advice_t> current_;
  bus::Periodic repeat_{bus::kSlowPeriod};
  std::int64_t jobs_ = 0;
  std::int64_t answers_ = 0;
  std::int64_t failures_ = 0;
  std::string last_error_;
  AdviceWorker worker_;  // last: its thread may call wake
};

}  // namespace terra::advisor

#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "advisor/anchor.h"
#include "advisor/backend.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// Runs a backend in a thread of its own: the newest task only, and a new task
/// stops the one before.
///
/// Threads: Start, Cancel and Take from the thread that acts; `ready` is called
///          from the worker when an answer can be taken.
class AdviceWorker {
 public:
  /// A task with its number and what keeps its map alive.
  struct Job {
    std::int64_t number = 0;
    std::shared_ptr<const TerrainMap> map;
    std::int64_t map_id = 0;
    std::int64_t request_id = 0;
    std::int64_t baseline_digest = 0;
    Anchor anchor;  ///< Where a proposal starts, ...
    Cell goal;
    Route route;  ///< ... and the route to beat from there to the goal.
    double route_cost = 0;
  };
  struct Finished {
    Job job;
    AdviceAnswer answer;
  };

  AdviceWorker(std::unique_ptr<Backend> backend, std::function<void()> ready);

  void Start(Job job);
  void Cancel();
  std::optional<Finished> Take();

  bool busy() const;
  const Backend& backend() const { return *backend_; }

 private:
  void Work(std::stop_token end);

  std::unique_ptr<Backend> backend_;
  std::function<void()> ready_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Job> waiting_;
  std::optional<Finished> finished_;
  bool busy_ = false;
  std::stop_source current_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace terra::advisor

#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "advisor/call_limits.h"
#include "advisor/llm_client.h"

namespace terra::advisor {

/// What a limit does to a call.
enum class AtLimit {
  kRefuse,  ///< No answer, at once: a robot goes on with its baseline.
  kWait,    ///< The call waits: an evaluation must not lose a case.
};

/// A snapshot for STATUS and reports.
struct CallFigures {
  CallStatistics statistics;
  double spend_last_hour_usd = 0;
  /// Calls pause until then: the breaker is open.
  std::chrono::steady_clock::time_point paused_until{};
};

/// Figures that another thread may read. Threads: all members.
class CallMonitor {
 public:
  CallFigures figures() const {
    const std::scoped_lock lock(mutex_);
    return figures_;
  }
  template <typename Change>
  void Update(Change change) {
    const std::scoped_lock lock(mutex_);
    change(figures_);
  }

 private:
  mutable std::mutex mutex_;
  CallFigures figures_;
};

/// Asks another client within limits, prices its replies and keeps figures.
class LimitedClient : public LlmClient {
 public:
  LimitedClient(std::unique_ptr<LlmClient> inner, const CallLimits& limits,
                PriceTable prices, AtLimit at_limit,
                std::shared_ptr<CallMonitor> monitor);

  const LlmIdentity& identity() const override { return inner_->identity(); }
  LlmReply Ask(const LlmRequest& request, std::stop_token stop) override;

 private:
  /// Returns why the call may not go, and until when.
  CallGate::Answer PassGate(std::stop_token stop);

  std::unique_ptr<LlmClient> inner_;
  CallGate gate_;
  PriceTable prices_;
  AtLimit at_limit_;
  std::shared_ptr<CallMonitor> monitor_;
};

}  // namespace terra::advisor

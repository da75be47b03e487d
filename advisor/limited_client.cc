#include "advisor/limited_client.h"

#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "advisor/interruptible_wait.h"

namespace terra::advisor {
namespace {

using Clock = std::chrono::steady_clock;

double NowSeconds() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

/// For people, beside the word that programs read.
std::string_view LimitText(NoAnswer reason) {
  switch (reason) {
    case NoAnswer::kRateLimit:
      return "--calls-per-minute is reached";
    case NoAnswer::kSpendLimit:
      return "--spend-per-hour is reached";
    default:
      return "calls pause after --breaker-failures in succession";
  }
}

}  // namespace

LimitedClient::LimitedClient(std::unique_ptr<LlmClient> inner,
                             const CallLimits& limits, PriceTable prices,
                             AtLimit at_limit,
                             std::shared_ptr<CallMonitor> monitor)
    : inner_(std::move(inner)),
      gate_(limits),
      prices_(std::move(prices)),
      at_limit_(at_limit),
      monitor_(std::move(monitor)) {}

CallGate::Answer LimitedClient::PassGate(std::stop_token stop) {
  for (;;) {
    const CallGate::Answer answer = gate_.MayCall(NowSeconds());
    if (answer.reason == NoAnswer::kNone || at_limit_ == AtLimit::kRefuse) {
      return answer;
    }
    if (!WaitUnlessStopped(answer.wait_s, stop)) {
      return {NoAnswer::kCancelled, 0};
    }
  }
}

LlmReply LimitedClient::Ask(const LlmRequest& request, std::stop_token stop) {
  LlmReply reply;
  const CallGate::Answer gate = PassGate(stop);
  reply.reason = gate.reason;
  if (reply.reason == NoAnswer::kNone) {
    gate_.Started(NowSeconds());
    reply = inner_->Ask(request, stop);
    if (!reply.spend_usd && reply.came()) {
      reply.spend_usd = prices_.Spend(identity(), reply);
    }
    gate_.Ended(reply, NowSeconds());
  } else if (reply.reason != NoAnswer::kCancelled) {
    reply.error = std::string(LimitText(gate.reason)) +
                  "; the next call may go in " +
                  std::to_string(std::lround(std::ceil(gate.wait_s))) + " s";
  }
  const double now = NowSeconds();
  monitor_->Update([&](CallFigures& figures) {
    figures.statistics.Add(reply);
    figures.spend_last_hour_usd = gate_.spend_last_hour(now);
    figures.paused_until =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(
                           std::chrono::duration<double>(gate_.pause_s(now)));
  });
  return reply;
}

}  // namespace terra::advisor

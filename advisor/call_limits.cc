#include "advisor/call_limits.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace terra::advisor {
namespace {

constexpr double kMinute = 60;
constexpr double kHour = 3'600;
constexpr std::size_t kLatenciesKept = 256;

std::optional<double> Price(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value) ||
      value < 0) {
    return std::nullopt;
  }
  return value;
}

}  // namespace

Status PriceTable::Add(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const std::size_t colon = text.rfind(':');
  if (equals != std::string::npos && colon != std::string::npos && equals > 0 &&
      equals < colon) {
    const std::string_view view = text;
    const auto input = Price(view.substr(equals + 1, colon - equals - 1));
    const auto output = Price(view.substr(colon + 1));
    if (input && output) {
      prices_[text.substr(0, equals)] = {*input, *output};
      return Done{};
    }
  }
  return Error{ErrorCode::kInvalid,
               "price '" + text +
                   "': write MODEL=INPUT:OUTPUT in dollars per million tokens"};
}

std::optional<double> PriceTable::Spend(const LlmIdentity& identity,
                                        const LlmReply& reply) const {
  auto price = prices_.find(reply.model);
  if (price == prices_.end()) price = prices_.find(identity.model);
  if (price == prices_.end()) {
    return std::nullopt;
  }
  return (static_cast<double>(reply.usage.tokens_in) * price->second.input +
          static_cast<double>(reply.usage.tokens_out) * price->second.output) /
         1e6;
}

CallGate::Answer CallGate::MayCall(double now_s) {
  if (const double pause = pause_s(now_s); pause > 0) {
    return {NoAnswer::kBreakerOpen, pause};
  }
  while (!started_.empty() && started_.front() <= now_s - kMinute) {
    started_.pop_front();
  }
  if (limits_.calls_per_minute > 0 &&
      started_.size() >= static_cast<std::size_t>(limits_.calls_per_minute)) {
    return {NoAnswer::kRateLimit, started_.front() + kMinute - now_s};
  }
  if (limits_.spend_per_hour_usd > 0 &&
      spend_last_hour(now_s) >= limits_.spend_per_hour_usd) {
    return {NoAnswer::kSpendLimit, spent_.front().at_s + kHour - now_s};
  }
  return {};
}

void CallGate::Started(double now_s) {
  if (limits_.calls_per_minute > 0) {
    started_.push_back(now_s);
  }
}

void CallGate::Ended(const LlmReply& reply, double now_s) {
  const double usd = reply.spend_usd.value_or(0);
  if (usd > 0) {
    // Filed under the end of its minute, so nothing is forgotten early.
    if (spent_.empty() || spent_.back().at_s <= now_s) {
      spent_.push_back({now_s + kMinute, 0});
    }
    spent_.back().usd += usd;
  }
  if (reply.came()) {
    failures_ = 0;
  } else if (reply.reason != NoAnswer::kCancelled &&
             reply.reason != NoAnswer::kNotRecorded) {
    ++failures_;
    if (limits_.breaker_failures > 0 && failures_ >= limits_.breaker_failures) {
      const int more = std::min(failures_ - limits_.breaker_failures, 30);
      paused_until_s_ =
          now_s + std::min(limits_.breaker_first_wait_s * std::exp2(more),
                           limits_.breaker_max_wait_s);
    }
  }
}

double CallGate::spend_last_hour(double now_s) {
  while (!spent_.empty() && spent_.front().at_s <= now_s - kHour) {
    spent_.pop_front();
  }
  double sum = 0;
  for (const Spent& spent : spent_) sum += spent.usd;
  return sum;
}

void CallStatistics::Add(const LlmReply& reply) {
  ++calls_;
  tokens_in_ += reply.usage.tokens_in;
  tokens_out_ += reply.usage.tokens_out;
  spend_usd_ += reply.spend_usd.value_or(0);
  if (!reply.came()) {
    ++no_answers_;
    return;
  }
  latencies_s_.push_back(reply.t_llm_s);
  if (latencies_s_.size() > kLatenciesKept) latencies_s_.pop_front();
}

double CallStatistics::latency_percentile_s(double percent) const {
  if (latencies_s_.empty()) {
    return 0;
  }
  std::vector<double> sorted(latencies_s_.begin(), latencies_s_.end());
  std::sort(sorted.begin(), sorted.end());
  const double rank =
      std::ceil(percent / 100 * static_cast<double>(sorted.size()));
  const auto at = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  return sorted[std::min(at, sorted.size() - 1)];
}

}  // namespace terra::advisor

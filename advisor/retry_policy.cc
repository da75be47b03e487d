#include "advisor/retry_policy.h"

#include <time.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace terra::advisor {
namespace {

const std::string* Header(const TryOutcome& outcome, const char* name) {
  const auto at = outcome.headers.find(name);
  return at == outcome.headers.end() ? nullptr : &at->second;
}

std::optional<double> NumberOf(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) {
    return std::nullopt;
  }
  return value;
}

/// Seconds until an HTTP date (RFC 9110, IMF-fixdate).
std::optional<double> SecondsUntil(const std::string& date,
                                   std::int64_t unix_now) {
  tm parts{};
  const char* end = strptime(date.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  if (end == nullptr || *end != '\0') {
    return std::nullopt;
  }
  return static_cast<double>(timegm(&parts) - unix_now);
}

/// What the server asks for, when it is a sensible wait.
std::optional<double> DemandedWait(const TryOutcome& outcome,
                                   std::int64_t unix_now) {
  const auto positive = [](std::optional<double> seconds) {
    return seconds && std::isfinite(*seconds) && *seconds > 0 ? seconds
                                                              : std::nullopt;
  };
  if (const std::string* ms = Header(outcome, "retry-after-ms")) {
    auto wait = NumberOf(*ms);
    if (wait) *wait /= 1000;
    if (positive(wait)) return wait;
  }
  if (const std::string* after = Header(outcome, "retry-after")) {
    auto wait = NumberOf(*after);
    if (!wait) wait = SecondsUntil(*after, unix_now);
    if (positive(wait)) return wait;
  }
  return positive(outcome.error.retry_after_s);
}

bool StatusMayPass(int status) {
  return status == 408 || status == 409 || status == 429 ||
         (status >= 500 && status != 501);
}

bool MayPass(const TryOutcome& outcome) {
  switch (outcome.fault) {
    case TransportFault::kConnect:
    case TransportFault::kBroken:
    case TransportFault::kTimeout:
      return true;
    case TransportFault::kTooLarge:
    case TransportFault::kCancelled:
    case TransportFault::kRefused:
      return false;
    case TransportFault::kNone:
      break;
  }
  if (outcome.reply_failed) return true;
  if (outcome.http_status < 400 || outcome.error.final) return false;
  if (const std::string* should = Header(outcome, "x-should-retry")) {
    if (*should == "true") return true;
    if (*should == "false") return false;
  }
  return StatusMayPass(outcome.http_status);
}

}  // namespace

RetryDecision DecideRetry(const TryOutcome& outcome, int retries_done,
                          double jitter, std::int64_t unix_now,
                          const RetryLimits& limits) {
  if (retries_done >= limits.max_retries || !MayPass(outcome)) {
    return {};
  }
  const double backoff =
      std::min(0.5 * std::exp2(retries_done), 8.0) * (1 - 0.25 * jitter);
  const double wait = DemandedWait(outcome, unix_now).value_or(backoff);
  if (wait > limits.max_wait_s) {
    return {};
  }
  return {true, wait};
}

}  // namespace terra::advisor

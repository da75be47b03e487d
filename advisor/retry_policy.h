#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "advisor/wire_format.h"

namespace terra::advisor {

/// How a request ended on its way, apart from any status.
enum class TransportFault {
  kNone,
  kConnect,    ///< Name, connection or TLS handshake: nothing was sent.
  kBroken,     ///< Reset, closed, or fewer bytes than announced.
  kTimeout,    ///< The time of one try is over.
  kTooLarge,   ///< The answer is larger than allowed.
  kCancelled,  ///< The caller asked to stop.
  kRefused,    ///< Not sent: a certificate or address that is not accepted.
};

/// One try as the policy sees it.
struct TryOutcome {
  TransportFault fault = TransportFault::kNone;
  int http_status = 0;
  /// Names in lower case.
  std::map<std::string, std::string> headers;
  WireError error;            ///< Of the body, where it reports one.
  bool reply_failed = false;  ///< A success that reports a passing failure.
  bool wrong_form = false;    ///< A success in another form than was expected.
};

struct RetryLimits {
  int max_retries = 3;     ///< After the first request (the paper's number).
  double max_wait_s = 60;  ///< A longer demand is a failure, not waited out.
};

/// May it be asked again, and after which wait?
struct RetryDecision {
  bool retry = false;
  double wait_s = 0;
};

/// Decides after a try that brought no answer.
///
/// Retried: connection faults and time-outs; 408, 409, 429 and 5xx but 501,
///          unless the body says that a quota is used up; x-should-retry
///          overrules the status. Answers are never asked for again.
/// Wait:    retry-after-ms, else retry-after (seconds or HTTP date), else what
///          the body says, else min(0.5 x 2^n, 8) s less up to a quarter.
///          Zero, past and unreadable values do not count.
/// `jitter` in [0, 1) and `unix_now` come from the caller: no clock in here.
/// Source: behaviour of the providers' SDKs.
RetryDecision DecideRetry(const TryOutcome& outcome, int retries_done,
                          double jitter, std::int64_t unix_now,
                          const RetryLimits& limits = {});

}  // namespace terra::advisor

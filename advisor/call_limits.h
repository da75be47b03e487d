#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "advisor/llm_client.h"
#include "terrain/result.h"

namespace terra::advisor {

/// US dollars per million tokens.
struct ModelPrice {
  double input = 0;
  double output = 0;
};

/// What models cost. Empty by default: prices change, and an invented one is
/// worse than none.
class PriceTable {
 public:
  /// Reads "MODEL=INPUT:OUTPUT". Errors say what is wrong.
  Status Add(const std::string& text);
  /// The model that the reply named, else the one asked for; none unknown.
  std::optional<double> Spend(const LlmIdentity& identity,
                              const LlmReply& reply) const;
  bool empty() const { return prices_.empty(); }
  bool Knows(const std::string& model) const { return prices_.contains(model); }

 private:
  std::map<std::string, ModelPrice> prices_;
};

/// How much may be asked. 0 = without that limit.
struct CallLimits {
  int calls_per_minute = 0;
  double spend_per_hour_usd = 0;
  int breaker_failures = 5;         ///< In succession, until it opens.
  double breaker_first_wait_s = 5;  ///< Doubles with each failure after.
  double breaker_max_wait_s = 300;
};

/// Counts calls and says when the next one may go. Pure: time is an argument
/// (seconds of any steady clock), so a test can run hours in no time.
class CallGate {
 public:
  explicit CallGate(const CallLimits& limits) : limits_(limits) {}

  /// May a call go now? If not: why, and after which time it is worth asking
  /// again. Counts nothing.
  struct Answer {
    NoAnswer reason = NoAnswer::kNone;
    double wait_s = 0;
  };
  Answer MayCall(double now_s);

  /// A call goes out.
  void Started(double now_s);
  /// A call ended. Cancelled ones count as neither failure nor success.
  void Ended(const LlmReply& reply, double now_s);

  /// How long the breaker stays open; 0 = it is closed.
  double pause_s(double now_s) const {
    return now_s < paused_until_s_ ? paused_until_s_ - now_s : 0;
  }
  double spend_last_hour(double now_s);
  int failures_in_succession() const { return failures_; }

 private:
  struct Spent {
    double at_s;
    double usd;
  };

  CallLimits limits_;
  std::deque<double> started_;  ///< At most calls_per_minute of them.
  std::deque<Spent> spent_;     ///< Of the last hour, a bucket per minute.
  int failures_ = 0;
  double paused_until_s_ = 0;
};

/// What STATUS tells of the calls.
class CallStatistics {
 public:
  void Add(const LlmReply& reply);
  std::int64_t calls() const { return calls_; }
  std::int64_t no_answers() const { return no_answers_; }
  std::int64_t tokens_in() const { return tokens_in_; }
  std::int64_t tokens_out() const { return tokens_out_; }
  double spend_usd() const { return spend_usd_; }
  /// Latency of the last 256 answered calls, nearest rank; 0 without any.
  double latency_percentile_s(double percent) const;

 private:
  std::int64_t calls_ = 0;
  std::int64_t no_answers_ = 0;
  std::int64_t tokens_in_ = 0;
  std::int64_t tokens_out_ = 0;
  double spend_usd_ = 0;
  std::deque<double> latencies_s_;
};

}  // namespace terra::advisor

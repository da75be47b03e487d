// When a call is tried again, when it may go at all, and what it costs: pure
// rules, with time as an argument.
#include <gtest/gtest.h>

#include "advisor/call_limits.h"
#include "advisor/retry_policy.h"

namespace terra::advisor {
namespace {

constexpr std::int64_t kNow = 1'800'000'000;  // Fri, 15 Jan 2027 08:00:00 GMT

TryOutcome Status(int status, std::map<std::string, std::string> headers = {}) {
  TryOutcome outcome;
  outcome.http_status = status;
  outcome.headers = std::move(headers);
  return outcome;
}

double WaitFor(const TryOutcome& outcome, double jitter = 0) {
  const RetryDecision decision = DecideRetry(outcome, 0, jitter, kNow);
  return decision.retry ? decision.wait_s : -1;
}

TEST(RetryPolicy, StatusesThatMayPassAreTriedAgain) {
  for (const int status : {408, 409, 429, 500, 502, 503, 504, 529, 599}) {
    EXPECT_TRUE(DecideRetry(Status(status), 0, 0, kNow).retry) << status;
  }
  for (const int status : {200, 301, 400, 401, 402, 403, 404, 413, 422, 501}) {
    EXPECT_FALSE(DecideRetry(Status(status), 0, 0, kNow).retry) << status;
  }
}

TEST(RetryPolicy, FaultsOnTheWayAreTriedAgainRefusalsAreNot) {
  for (const auto fault : {TransportFault::kConnect, TransportFault::kBroken,
                           TransportFault::kTimeout}) {
    TryOutcome outcome;
    outcome.fault = fault;
    EXPECT_TRUE(DecideRetry(outcome, 0, 0, kNow).retry);
  }
  for (const auto fault :
       {TransportFault::kTooLarge, TransportFault::kCancelled,
        TransportFault::kRefused}) {
    TryOutcome outcome;
    outcome.fault = fault;
    EXPECT_FALSE(DecideRetry(outcome, 0, 0, kNow).retry);
  }
}

TEST(RetryPolicy, AUsedUpQuotaIsFinal) {
  TryOutcome outcome = Status(429);
  outcome.error.final = true;
  EXPECT_FALSE(DecideRetry(outcome, 0, 0, kNow).retry);
}

TEST(RetryPolicy, TheServersOwnWordOverrulesTheStatus) {
  EXPECT_TRUE(
      DecideRetry(Status(400, {{"x-should-retry", "true"}}), 0, 0, kNow).retry);
  EXPECT_FALSE(
      DecideRetry(Status(500, {{"x-should-retry", "false"}}), 0, 0, kNow)
          .retry);
}

TEST(RetryPolicy, EveryFormOfADemandedWaitIsRead) {
  EXPECT_DOUBLE_EQ(WaitFor(Status(429, {{"retry-after-ms", "1500"}})), 1.5);
  EXPECT_DOUBLE_EQ(WaitFor(Status(429, {{"retry-after", "7"}})), 7);
  EXPECT_DOUBLE_EQ(WaitFor(Status(429, {{"retry-after", "1.5"}})), 1.5);
  EXPECT_DOUBLE_EQ(
      WaitFor(Status(429, {{"retry-after", "Fri, 15 Jan 2027 08:00:30 GMT"}})),
      30);
  EXPECT_DOUBLE_EQ(
      WaitFor(Status(429, {{"retry-after-ms", "20"}, {"retry-after", "7"}})),
      0.02)
      << "the finer one wins";
  TryOutcome body = Status(429);
  body.error.retry_after_s = 22;
  EXPECT_DOUBLE_EQ(WaitFor(body), 22);
}

TEST(RetryPolicy, ZeroPastAndUnreadableDemandsDoNotCount) {
  for (const char* demand :
       {"0", "-3", "soon", "", "nan", "inf", "1e400", "7 seconds",
        "Fri, 15 Jan 2027 07:59:00 GMT", "Someday, 99 Foo 2027"}) {
    EXPECT_DOUBLE_EQ(WaitFor(Status(429, {{"retry-after", demand}})), 0.5)
        << demand;
    EXPECT_DOUBLE_EQ(WaitFor(Status(429, {{"retry-after-ms", demand}})), 0.5)
        << demand;
  }
}

TEST(RetryPolicy, TheWaitDoublesWithJitterUpToEightSeconds) {
  RetryLimits many;
  many.max_retries = 20;
  const double expected[] = {0.5, 1, 2, 4, 8, 8, 8};
  for (int n = 0; n < 7; ++n) {
    EXPECT_DOUBLE_EQ(DecideRetry(Status(500), n, 0, kNow, many).wait_s,
                     expected[n]);
    EXPECT_DOUBLE_EQ(DecideRetry(Status(500), n, 0.8, kNow, many).wait_s,
                     0.8 * expected[n]);
  }
}

TEST(RetryPolicy, LongDemandsAndTheFourthFailureEndIt) {
  EXPECT_FALSE(
      DecideRetry(Status(429, {{"retry-after", "61"}}), 0, 0, kNow).retry);
  EXPECT_TRUE(DecideRetry(Status(500), 2, 0, kNow).retry);
  EXPECT_FALSE(DecideRetry(Status(500), 3, 0, kNow).retry);
}

LlmReply Answered(double usd = 0) {
  LlmReply reply;
  reply.status = ReplyStatus::kAnswered;
  if (usd > 0) reply.spend_usd = usd;
  return reply;
}

LlmReply Unanswered(NoAnswer reason) {
  LlmReply reply;
  reply.reason = reason;
  return reply;
}

TEST(CallGate, CallsPerMinuteAreThoseOfTheLastMinute) {
  CallGate gate({.calls_per_minute = 2});
  for (const double at : {0.0, 10.0}) {
    EXPECT_EQ(gate.MayCall(at).reason, NoAnswer::kNone);
    gate.Started(at);
  }
  const auto refused = gate.MayCall(20);
  EXPECT_EQ(refused.reason, NoAnswer::kRateLimit);
  EXPECT_DOUBLE_EQ(refused.wait_s, 40);
  EXPECT_EQ(gate.MayCall(60).reason, NoAnswer::kNone);
  gate.Started(60);
  EXPECT_EQ(gate.MayCall(61).reason, NoAnswer::kRateLimit);
}

TEST(CallGate, SpendPerHourIsThatOfTheLastHour) {
  CallGate gate({.spend_per_hour_usd = 1});
  gate.Ended(Answered(0.6), 0);
  EXPECT_EQ(gate.MayCall(1).reason, NoAnswer::kNone);
  gate.Ended(Answered(0.6), 120);
  const auto refused = gate.MayCall(200);
  EXPECT_EQ(refused.reason, NoAnswer::kSpendLimit);
  EXPECT_EQ(gate.MayCall(200 + refused.wait_s).reason, NoAnswer::kNone);
  EXPECT_DOUBLE_EQ(gate.spend_last_hour(200 + refused.wait_s), 0.6);
}

TEST(CallGate, TheBreakersPauseDoublesUntilACallIsAnswered) {
  CallGate gate({.breaker_failures = 2,
                 .breaker_first_wait_s = 5,
                 .breaker_max_wait_s = 12});
  gate.Ended(Unanswered(NoAnswer::kTransport), 0);
  EXPECT_EQ(gate.pause_s(0), 0);
  gate.Ended(Unanswered(NoAnswer::kHttpStatus), 0);
  EXPECT_EQ(gate.MayCall(4.9).reason, NoAnswer::kBreakerOpen);
  EXPECT_EQ(gate.MayCall(5).reason, NoAnswer::kNone);
  gate.Ended(Unanswered(NoAnswer::kDeadline), 5);
  EXPECT_GT(gate.pause_s(14.9), 0);
  gate.Ended(Unanswered(NoAnswer::kDeadline), 15);
  EXPECT_GT(gate.pause_s(26.9), 0);
  EXPECT_EQ(gate.pause_s(27), 0) << "never longer than allowed";
  gate.Ended(Answered(), 27);
  EXPECT_EQ(gate.failures_in_succession(), 0);
  gate.Ended(Unanswered(NoAnswer::kTransport), 28);
  EXPECT_EQ(gate.pause_s(28), 0);
}

TEST(CallGate, ACancelledCallIsNoFailure) {
  CallGate gate({.breaker_failures = 1});
  gate.Ended(Unanswered(NoAnswer::kCancelled), 0);
  EXPECT_EQ(gate.pause_s(0), 0);
}

TEST(PriceTable, PricesTheModelThatAnsweredElseTheOneAskedFor) {
  PriceTable prices;
  ASSERT_TRUE(prices.Add("gpt-5.5=2:10").ok());
  ASSERT_TRUE(prices.Add("gpt-5.5-mini=1:1").ok());
  LlmReply reply = Answered();
  reply.usage = {1'000'000, 100'000, 0};
  const LlmIdentity asked{"openai", "gpt-5.5", "{}", "provider"};
  EXPECT_DOUBLE_EQ(prices.Spend(asked, reply).value(), 3);
  reply.model = "gpt-5.5-mini";
  EXPECT_DOUBLE_EQ(prices.Spend(asked, reply).value(), 1.1);
  EXPECT_FALSE(prices.Spend({"openai", "other", "{}", ""}, Answered()));
}

TEST(PriceTable, RefusesWhatIsNoPrice) {
  PriceTable prices;
  for (const char* text : {"", "m", "m=", "m=1", "m=1:", "m=:1", "=1:1",
                           "m=-1:1", "m=1:nan", "m=1:2x", "m:1=2"}) {
    EXPECT_FALSE(prices.Add(text).ok()) << text;
  }
  EXPECT_TRUE(prices.empty());
}

TEST(CallStatistics, PercentilesAreNearestRankOverTheLastAnswers) {
  CallStatistics statistics;
  EXPECT_EQ(statistics.latency_percentile_s(95), 0);
  for (int i = 1; i <= 100; ++i) {
    LlmReply reply = Answered(0.01);
    reply.t_llm_s = i;
    statistics.Add(reply);
  }
  statistics.Add(Unanswered(NoAnswer::kDeadline));
  EXPECT_EQ(statistics.latency_percentile_s(50), 50);
  EXPECT_EQ(statistics.latency_percentile_s(95), 95);
  EXPECT_EQ(statistics.calls(), 101);
  EXPECT_EQ(statistics.no_answers(), 1);
  EXPECT_NEAR(statistics.spend_usd(), 1, 1e-9);
}

}  // namespace
}  // namespace terra::advisor

// Calls that fail: what is asked again, how long is waited, how a call ends.
#include <array>
#include <ctime>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/advisor/provider_calls.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;

class ProviderRetryTest : public EveryProviderTest {};
INSTANTIATE_TEST_SUITE_P(All, ProviderRetryTest,
                         ::testing::Values("openai", "gemini", "anthropic",
                                           "chat"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(ProviderRetryTest, RetriesTransientFailuresAtMostThreeTimes) {
  ScriptedLlmServer server({Failing(503, "retry-after-ms", "1")});
  const LlmReply reply = Client(GetParam(), server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
  EXPECT_EQ(reply.http_status, 503);
  EXPECT_EQ(reply.tries, 4);
  EXPECT_EQ(server.request_count(), 4);
}

TEST(ProviderClientTest, ARefusedKeyIsNotTriedAgain) {
  ScriptedLlmServer server({Failing(401)});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.tries, 1);
  EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
  EXPECT_THAT(reply.error, HasSubstr("HTTP 401: no"));
}

TEST(ProviderClientTest, ErrorsSayWhatToDo) {
  const auto error = [](const ScriptedReply& scripted) {
    ScriptedLlmServer server({scripted});
    return Client("openai", server.url())->Ask(Question(), {}).error;
  };
  EXPECT_THAT(error(Failing(401)), HasSubstr("set the environment variable "
                                             "OPENAI_API_KEY"));
  setenv("OPENAI_API_KEY", kSecret, 1);
  EXPECT_THAT(error(Failing(401)), HasSubstr("check the key in the environment "
                                             "variable OPENAI_API_KEY"));
  unsetenv("OPENAI_API_KEY");
  EXPECT_THAT(error(Failing(404)), HasSubstr("check --base-url"));
  EXPECT_THAT(error(Failing(429, "retry-after-ms", "1")),
              HasSubstr("(asked 4 times)"));
  ScriptedReply page;
  page.body = "<html>please log in</html>";
  EXPECT_THAT(error(page), HasSubstr("speak this backend's form?"));

  std::string closed_url;
  {
    ScriptedLlmServer server({page});
    closed_url = server.url();
  }
  ProviderOptions options;
  options.base_url = closed_url;
  options.retry.max_retries = 0;
  auto client = ProviderClient::Create("openai", options);
  ASSERT_TRUE(client.ok());
  EXPECT_THAT((*client)->Ask(Question(), {}).error,
              HasSubstr(closed_url + "/v1/responses): does the server run"));
}

TEST(ProviderClientTest, EveryFormOfADemandedWaitLeadsToTheAnswer) {
  std::array<char, 64> soon{};
  const std::time_t at = std::time(nullptr) + 1;
  tm parts{};
  gmtime_r(&at, &parts);
  std::strftime(soon.data(), soon.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{
           {"retry-after-ms", "1"},
           {"retry-after", "0.01"},
           {"retry-after", soon.data()},
           {"retry-after", "Thu, 01 Jan 1970 00:00:00 GMT"},
           {"retry-after", "later"}}) {
    ScriptedLlmServer server({Failing(429, name, value), Good("openai")});
    const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
    EXPECT_EQ(reply.text, "Yes") << name << ": " << value << reply.error;
    EXPECT_EQ(reply.tries, 2) << name << ": " << value;
  }
}

TEST(ProviderClientTest, AnAnswerAfterFailuresCounts) {
  ScriptedReply reset;
  reset.reset = true;
  ScriptedReply half = Good("openai");
  half.body_share = 0.5;
  ScriptedLlmServer server(
      {reset, half, Failing(429, "retry-after-ms", "5"), Good("openai")});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.status, ReplyStatus::kAnswered) << reply.error;
  EXPECT_EQ(reply.tries, 4);
}

TEST(ProviderClientTest, AStalledServerCostsOneTryTimeEach) {
  ScriptedReply stall = Good("openai");
  stall.body_share = 0.5;
  stall.stall = true;
  ScriptedLlmServer server({stall, Good("openai")});
  const LlmReply reply =
      Client("openai", server.url(), 0.3)->Ask(Question(), {});
  EXPECT_EQ(reply.status, ReplyStatus::kAnswered) << reply.error;
  EXPECT_EQ(reply.tries, 2);
}

TEST(ProviderClientTest, TheDeadlineHoldsWhateverTheServerDemands) {
  ScriptedReply silent;
  silent.silent = true;
  ScriptedLlmServer server({silent});
  const LlmReply reply =
      Client("openai", server.url(), 5, 0.3)->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kDeadline);

  ScriptedLlmServer patient({Failing(429, "retry-after", "1")});
  const LlmReply late =
      Client("openai", patient.url(), 5, 0.5)->Ask(Question(), {});
  EXPECT_EQ(late.reason, NoAnswer::kDeadline);
  EXPECT_EQ(late.tries, 1);
}

TEST(ProviderClientTest, ALongerDemandThanAllowedIsAFailure) {
  ScriptedLlmServer server({Failing(429, "retry-after", "3600")});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
  EXPECT_EQ(reply.tries, 1);
}

TEST(ProviderClientTest, CancellingEndsACallThatHangs) {
  ScriptedReply silent;
  silent.silent = true;
  ScriptedLlmServer server({silent, Good("openai")});
  auto client = Client("openai", server.url(), 60, 60);
  std::stop_source stop;
  std::jthread caller([&] {
    server.WaitForRequests(1, 10);
    stop.request_stop();
  });
  const LlmReply reply = client->Ask(Question(), stop.get_token());
  EXPECT_EQ(reply.reason, NoAnswer::kCancelled);
  EXPECT_LT(reply.t_llm_s, 30);
  // And the client is ready for the next call.
  EXPECT_EQ(client->Ask(Question(), {}).text, "Yes");
}

TEST(ProviderClientTest, CancellingEndsAWaitBetweenTries) {
  ScriptedLlmServer server({Failing(429, "retry-after", "2")});
  auto client = Client("openai", server.url());
  std::stop_source stop;
  std::jthread caller([&] {
    server.WaitForRequests(1, 10);
    stop.request_stop();
  });
  EXPECT_EQ(client->Ask(Question(), stop.get_token()).reason,
            NoAnswer::kCancelled);
}

TEST(ProviderClientTest, AFailureInsideASuccessIsTriedAgainWhenItMayPass) {
  ScriptedReply failed;
  failed.body =
      R"({"status":"failed","error":{"code":"server_error","message":"x"}})";
  ScriptedReply final;
  final.body =
      R"({"status":"failed","error":{"code":"invalid_image","message":"x"}})";
  ScriptedLlmServer server({failed, Good("openai"), final});
  auto client = Client("openai", server.url());
  EXPECT_EQ(client->Ask(Question(), {}).tries, 2);
  EXPECT_EQ(client->Ask(Question(), {}).tries, 1);
}

}  // namespace
}  // namespace terra::advisor

#include "advisor/provider_client.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "tests/support/child_process.h"
#include "tests/support/scripted_llm_server.h"
#include "tests/support/temp_folder.h"

namespace terra::advisor {
namespace {

using testing::ErrorBody;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReplyBody;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

constexpr const char* kSecret = "sk-secret-0123456789";

std::unique_ptr<LlmClient> Client(const std::string& provider,
                                  const std::string& url, double try_s = 5,
                                  double deadline_s = 20) {
  ProviderOptions options;
  options.base_url = url;
  options.try_timeout_s = try_s;
  options.deadline_s = deadline_s;
  options.retry.max_wait_s = 2;
  auto client = ProviderClient::Create(provider, options);
  EXPECT_TRUE(client.ok()) << client.error().message;
  return std::move(client.value());
}

LlmRequest Question() {
  LlmRequest request;
  request.text = "question";
  request.method = "advisor";
  return request;
}

ScriptedReply Good(const std::string& provider,
                   const std::string& text = "Yes") {
  ScriptedReply reply;
  reply.body = ReplyBody(provider, text);
  return reply;
}

ScriptedReply Failing(int status, std::string name = "",
                      std::string value = "") {
  ScriptedReply reply;
  reply.status = status;
  reply.body = ErrorBody("openai", "no");
  if (!name.empty()) reply.headers = {{name, value}};
  return reply;
}

class EveryProviderTest : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, EveryProviderTest,
                         ::testing::Values("openai", "gemini", "anthropic",
                                           "chat"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(EveryProviderTest, AnswerModelAndTokensAreReadFromTheReply) {
  ScriptedLlmServer server({Good(GetParam(), "No. [(1, 2), (3, 4)]")});
  const LlmReply reply = Client(GetParam(), server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.status, ReplyStatus::kAnswered) << reply.error;
  EXPECT_EQ(reply.text, "No. [(1, 2), (3, 4)]");
  EXPECT_EQ(reply.model, "scripted");
  EXPECT_EQ(reply.usage.tokens_in, 1000);
  EXPECT_EQ(reply.usage.tokens_out, 20);
  EXPECT_EQ(reply.tries, 1);
}

TEST_P(EveryProviderTest, TheVersionMayStandAtTheEndOfTheBaseAddress) {
  ScriptedLlmServer server({Good(GetParam())});
  const std::string version = GetParam() == "gemini" ? "/v1beta/" : "/v1";
  Client(GetParam(), server.url() + version)->Ask(Question(), {});
  Client(GetParam(), server.url())->Ask(Question(), {});
  const auto seen = server.requests();
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen.front().path, seen.back().path);
}

TEST_P(EveryProviderTest, RetriesTransientFailuresAtMostThreeTimes) {
  ScriptedLlmServer server({Failing(503, "retry-after-ms", "1")});
  const LlmReply reply = Client(GetParam(), server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
  EXPECT_EQ(reply.http_status, 503);
  EXPECT_EQ(reply.tries, 4);
  EXPECT_EQ(server.request_count(), 4);
}

TEST_P(EveryProviderTest, TheKeyIsSentButNeverComesBack) {
  const std::string variable(MakeWireFormat(GetParam())->key_variable());
  setenv(variable.c_str(), kSecret, 1);
  ScriptedReply echo = Good(GetParam(), std::string("No ") + kSecret);
  ScriptedReply refusal;
  refusal.status = 401;
  refusal.body = ErrorBody(GetParam(), std::string("bad key ") + kSecret);
  ScriptedLlmServer server({echo, refusal});
  auto client = Client(GetParam(), server.url());
  unsetenv(variable.c_str());
  for (int i = 0; i < 2; ++i) {
    const LlmReply reply = client->Ask(Question(), {});
    EXPECT_THAT(reply.text, Not(HasSubstr(kSecret)));
    EXPECT_THAT(reply.error, Not(HasSubstr(kSecret)));
    EXPECT_THAT(reply.body, Not(HasSubstr(kSecret)));
  }
  std::string sent;
  const auto seen = server.requests();
  for (const auto& [name, value] : seen.front().headers) {
    sent += name + ": " + value + "\n";
  }
  EXPECT_THAT(sent, HasSubstr(kSecret));
}

TEST(ProviderClientTest, AKeyWithEscapesIsCutOutOfTheReplyToo) {
  setenv("OPENAI_API_KEY", "sk/secret/0123456789", 1);
  ScriptedReply echo = Good("openai");
  echo.body.insert(1, R"("you_sent":"sk\/secret\u002f0123456789",)");
  ScriptedLlmServer server({echo});
  auto client = Client("openai", server.url());
  unsetenv("OPENAI_API_KEY");
  const LlmReply reply = client->Ask(Question(), {});
  EXPECT_EQ(reply.text, "Yes") << reply.error;
  EXPECT_THAT(reply.body, HasSubstr("[key]"));
  EXPECT_THAT(reply.body, Not(HasSubstr("0123456789")));
}

TEST(ProviderClientTest, AProcessWithAKeyLeavesNoCore) {
  setenv("OPENAI_API_KEY", kSecret, 1);
  Client("openai", "http://127.0.0.1:1");
  unsetenv("OPENAI_API_KEY");
  EXPECT_EQ(prctl(PR_GET_DUMPABLE), 0);
  rlimit core{};
  ASSERT_EQ(getrlimit(RLIMIT_CORE, &core), 0);
  EXPECT_EQ(core.rlim_max, 0u);
}

TEST(ProviderClientTest, ACertificateThatNobodyVouchesForIsRefused) {
  const testing::TempFolder folder;
  const auto made = testing::RunToEnd(
      {"sh", "-c",
       "command -v openssl >/dev/null || exit 77; openssl req -x509 -nodes "
       "-newkey ec -pkeyopt ec_paramgen_curve:P-256 -subj /CN=localhost "
       "-keyout " +
           folder.Path("key") + " -out " + folder.Path("cert")});
  if (made.exit_code == 77) GTEST_SKIP() << "no openssl command";
  ASSERT_EQ(made.exit_code, 0) << made.output;
  testing::ChildProcess server({"openssl", "s_server", "-accept", "127.0.0.1:0",
                                "-cert", folder.Path("cert"), "-key",
                                folder.Path("key"), "-www"});
  std::string port;  // "ACCEPT 127.0.0.1:PORT"
  for (int i = 0; port.empty() && i < 2'000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::string said = server.output();
    const std::size_t at = said.find("ACCEPT 127.0.0.1:");
    const std::size_t end = said.find('\n', at);
    if (at != std::string::npos && end != std::string::npos) {
      port = said.substr(at + 17, end - at - 17);
    }
  }
  ASSERT_FALSE(port.empty()) << server.output();
  HttpTransport http;
  HttpRequest request;
  request.url = "https://127.0.0.1:" + port;
  const HttpReply reply = http.Post(request, {});
  EXPECT_EQ(reply.fault, TransportFault::kRefused) << reply.fault_text;
  EXPECT_THAT(reply.fault_text, HasSubstr("certificate"));
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

TEST(ProviderClientTest, NothingFromOutsideSteersATerminal) {
  ScriptedReply hostile = Failing(400);
  hostile.body = ErrorBody("openai", "bad\x1b[2J\r\nmodel\x7f");
  ScriptedLlmServer server({hostile});
  const std::string error =
      Client("openai", server.url())->Ask(Question(), {}).error;
  EXPECT_EQ(error.find_first_of("\x1b\r\n\x7f"), std::string::npos) << error;
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

TEST(ProviderClientTest, AWrongContentTypeDoesNotMatter) {
  ScriptedReply odd = Good("openai");
  odd.content_type = "text/html; charset=latin1";
  ScriptedLlmServer server({odd});
  EXPECT_EQ(Client("openai", server.url())->Ask(Question(), {}).text, "Yes");
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

TEST(ProviderClientTest, BodiesThatAreNoReplyAreNoAnswer) {
  for (const std::string body :
       {"<html>busy</html>", "", "[1]", "{\"status\": \"completed\"}",
        "{\"status\":\"completed\",\"output\":\"\xff\"}", "{\"output\": []}"}) {
    ScriptedReply bad;
    bad.body = body;
    bad.content_type = "text/html";
    ScriptedLlmServer server({bad});
    const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
    EXPECT_EQ(reply.reason, NoAnswer::kBadReply) << body;
    EXPECT_EQ(reply.tries, 1) << body;
    EXPECT_THAT(reply.error, Not(HasSubstr("\xff")));
  }
}

TEST(ProviderClientTest, HugeBodiesAreCutOff) {
  ScriptedReply huge;
  huge.body = std::string(16u << 20, ' ');
  ScriptedLlmServer server({huge});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kTooLarge);
  EXPECT_EQ(reply.tries, 1);
}

TEST(ProviderClientTest, RedirectsAreNotFollowed) {
  ScriptedLlmServer target({Good("openai")});
  ScriptedLlmServer server(
      {Failing(307, "location", target.url() + "/v1/responses")});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
  EXPECT_EQ(target.request_count(), 0);
}

TEST(ProviderClientTest, LargeRequestsDoNotWaitForPermission) {
  ScriptedLlmServer server({Good("openai")});
  LlmRequest request = Question();
  request.text.assign(3u << 20, 'x');
  const LlmReply reply = Client("openai", server.url())->Ask(request, {});
  EXPECT_EQ(reply.text, "Yes") << reply.error;
  EXPECT_EQ(server.requests().front().Header("expect"), "");
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

TEST(ProviderClientTest, RealProvidersNeedAKey) {
  for (const char* provider : {"openai", "gemini", "anthropic"}) {
    const auto client = ProviderClient::Create(provider, {});
    ASSERT_FALSE(client.ok()) << provider;
    EXPECT_THAT(client.error().message, HasSubstr("API_KEY"));
  }
}

TEST(ProviderClientTest, AServerOnThisMachineIsNoRealModelUnlessSaid) {
  ProviderOptions options;
  EXPECT_EQ(
      (*ProviderClient::Create("chat", options))->identity().endpoint_class,
      "loopback");
  options.real_model = true;
  EXPECT_EQ(
      (*ProviderClient::Create("chat", options))->identity().endpoint_class,
      "loopback-model");
  options.base_url = "https://example.org";
  EXPECT_EQ(
      (*ProviderClient::Create("chat", options))->identity().endpoint_class,
      "other");
}

TEST(ProviderClientTest, PlainHttpIsForThisMachineOnly) {
  EXPECT_EQ(CheckBaseUrl("http://127.0.0.1:80").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("http://localhost").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("http://[::1]:5").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("https://example.org").value(), "other");
  for (const char* bad :
       {"http://example.org", "http://127.0.0.1.example.org",
        "http://localhost.example.org", "ftp://127.0.0.1", "file:///etc/passwd",
        "https://user:secret@example.org", "https://example.org/?key=secret",
        "", "http://"}) {
    EXPECT_FALSE(CheckBaseUrl(bad).ok()) << bad;
  }
}

}  // namespace
}  // namespace terra::advisor

// What a provider must not get, learn or do: keys, certificates, addresses.
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "advisor/http_transport.h"
#include "tests/advisor/provider_calls.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ProviderKeyTest : public EveryProviderTest {};
INSTANTIATE_TEST_SUITE_P(All, ProviderKeyTest,
                         ::testing::Values("openai", "gemini", "anthropic",
                                           "chat"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(ProviderKeyTest, TheKeyIsSentButNeverComesBack) {
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

TEST(ProviderSecurityTest, AKeyWithEscapesIsCutOutOfTheReplyToo) {
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

TEST(ProviderSecurityTest, AProcessWithAKeyLeavesNoCore) {
  setenv("OPENAI_API_KEY", kSecret, 1);
  Client("openai", "http://127.0.0.1:1");
  unsetenv("OPENAI_API_KEY");
  EXPECT_EQ(prctl(PR_GET_DUMPABLE), 0);
  rlimit core{};
  ASSERT_EQ(getrlimit(RLIMIT_CORE, &core), 0);
  EXPECT_EQ(core.rlim_max, 0u);
}

TEST(ProviderSecurityTest, ACertificateThatNobodyVouchesForIsRefused) {
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

TEST(ProviderSecurityTest, NothingFromOutsideSteersATerminal) {
  ScriptedReply hostile = Failing(400);
  hostile.body = ErrorBody("openai", "bad\x1b[2J\r\nmodel\x7f\u009b2J");
  ScriptedLlmServer server({hostile});
  const std::string error =
      Client("openai", server.url())->Ask(Question(), {}).error;
  EXPECT_EQ(error.find_first_of("\x1b\r\n\x7f"), std::string::npos) << error;
  EXPECT_EQ(error.find("\u009b"), std::string::npos) << error;
}

TEST(ProviderSecurityTest, NoValueBeginsAHeaderOfItsOwn) {
  ScriptedLlmServer server({Good("anthropic")});
  ProviderOptions options;
  options.base_url = server.url();
  options.settings.anthropic_version = "2023-06-01\r\nx-evil: 1";
  auto client = ProviderClient::Create("anthropic", options);
  ASSERT_TRUE(client.ok());
  const LlmReply reply = (*client)->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kTransport);
  EXPECT_THAT(reply.error, HasSubstr("control character"));
  EXPECT_EQ(server.request_count(), 0);
}

/// Sets the variables by which a proxy is named, for as long as it lives.
class ProxyVariables {
 public:
  explicit ProxyVariables(const std::string& url) {
    for (const char* name : kNames) setenv(name, url.c_str(), 1);
  }
  ~ProxyVariables() {
    for (const char* name : kNames) unsetenv(name);
  }
  ProxyVariables(const ProxyVariables&) = delete;
  ProxyVariables& operator=(const ProxyVariables&) = delete;

 private:
  static constexpr const char* kNames[] = {
      "http_proxy", "https_proxy", "HTTPS_PROXY", "all_proxy", "ALL_PROXY"};
};

TEST(ProviderSecurityTest, NoProxySeesWhatGoesToThisMachine) {
  ScriptedLlmServer proxy({Good("chat", "from the proxy")});
  ScriptedLlmServer server({Good("chat", "from the server")});
  const ProxyVariables variables(proxy.url());
  setenv("TERRA_CHAT_API_KEY", kSecret, 1);
  const std::string port = std::to_string(server.port());
  for (const char* base :
       {"http://127.0.0.1:", "HTTP://127.0.0.1:", "Http://127.0.0.1:",
        "http://localhost:", "HTTP://LOCALHOST:"}) {
    EXPECT_EQ(Client("chat", base + port)->Ask(Question(), {}).text,
              "from the server")
        << base;
  }
  unsetenv("TERRA_CHAT_API_KEY");
  EXPECT_EQ(server.request_count(), 5);
  EXPECT_EQ(proxy.request_count(), 0);
  // And the proxy is one: what goes elsewhere asks it first.
  HttpTransport http;
  HttpRequest elsewhere;
  elsewhere.url = "HTTPS://example.invalid";
  elsewhere.timeout_s = 5;
  EXPECT_NE(http.Post(elsewhere, {}).fault, TransportFault::kNone);
  EXPECT_EQ(proxy.request_count(), 1);
}

TEST(ProviderSecurityTest, HeaderNamesAreReadInAnyCase) {
  ScriptedReply busy = Failing(503, "RETRY-AFTER-MS", "1");
  ScriptedLlmServer server({busy, Good("chat")});
  EXPECT_EQ(Client("chat", server.url())->Ask(Question(), {}).tries, 2);
  ScriptedReply final_one = Failing(503, "X-Should-Retry", "false");
  ScriptedLlmServer other({final_one});
  EXPECT_EQ(Client("chat", other.url())->Ask(Question(), {}).tries, 1);
}

TEST(ProviderSecurityTest, RedirectsAreNotFollowed) {
  ScriptedLlmServer target({Good("openai")});
  ScriptedLlmServer server(
      {Failing(307, "location", target.url() + "/v1/responses")});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
  EXPECT_EQ(target.request_count(), 0);
}

TEST(ProviderSecurityTest, RealProvidersNeedAKey) {
  for (const char* provider : {"openai", "gemini", "anthropic"}) {
    const auto client = ProviderClient::Create(provider, {});
    ASSERT_FALSE(client.ok()) << provider;
    EXPECT_THAT(client.error().message, HasSubstr("API_KEY"));
  }
}

TEST(ProviderSecurityTest, AServerOnThisMachineIsNoRealModelUnlessSaid) {
  ProviderOptions options;
  EXPECT_EQ(
      (*ProviderClient::Create("chat", options))->identity().endpoint_class,
      "loopback");
  options.real_model = true;
  EXPECT_EQ(
      (*ProviderClient::Create("chat", options))->identity().endpoint_class,
      "loopback-model");
}

TEST(ProviderSecurityTest, AServerElsewhereIsToldByItsAddress) {
  ProviderOptions options;
  const auto endpoint = [&options](const std::string& base_url) {
    options.base_url = base_url;
    return (*ProviderClient::Create("chat", options))
        ->identity()
        .endpoint_class;
  };
  EXPECT_EQ(endpoint("https://example.org"),
            "other https://example.org/v1/chat/completions");
  EXPECT_EQ(endpoint("https://example.org/v1/"),
            endpoint("https://example.org"));
  EXPECT_NE(endpoint("https://example.org:8443"),
            endpoint("https://example.org"));
}

TEST(ProviderSecurityTest, PlainHttpIsForThisMachineOnly) {
  EXPECT_EQ(CheckBaseUrl("http://127.0.0.1:80").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("http://localhost").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("http://[::1]:5").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("https://example.org").value(), "other");
  EXPECT_EQ(CheckBaseUrl("HTTP://LocalHost:80").value(), "loopback");
  EXPECT_EQ(CheckBaseUrl("HTTPS://LOCALHOST").value(), "loopback")
      << "or a program that plays a model would pass for one";
  for (const char* bad :
       {"http://example.org", "http://127.0.0.1.example.org",
        "http://localhost.example.org", "http://127.0.0.1.2.3", "http://127.",
        "HTTP://EXAMPLE.ORG", "ftp://127.0.0.1", "FILE:///etc/passwd",
        "file:///etc/passwd", "https://user:secret@example.org",
        "https://example.org/?key=secret", "", "http://"}) {
    EXPECT_FALSE(CheckBaseUrl(bad).ok()) << bad;
  }
}

}  // namespace
}  // namespace terra::advisor

#pragma once

#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "advisor/provider_client.h"
#include "tests/support/scripted_llm_server.h"

namespace terra::advisor {

using testing::ErrorBody;
using testing::ReplyBody;
using testing::ScriptedLlmServer;
using testing::ScriptedReply;

inline constexpr const char* kSecret = "sk-secret-0123456789";

inline std::unique_ptr<LlmClient> Client(const std::string& provider,
                                         const std::string& url,
                                         double try_s = 5,
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

inline LlmRequest Question() {
  LlmRequest request;
  request.text = "question";
  request.method = "advisor";
  return request;
}

inline ScriptedReply Good(const std::string& provider,
                          const std::string& text = "Yes") {
  ScriptedReply reply;
  reply.body = ReplyBody(provider, text);
  return reply;
}

inline ScriptedReply Failing(int status, std::string name = "",
                             std::string value = "") {
  ScriptedReply reply;
  reply.status = status;
  reply.body = ErrorBody("openai", "no");
  if (!name.empty()) reply.headers = {{name, value}};
  return reply;
}

class EveryProviderTest : public ::testing::TestWithParam<std::string> {};

}  // namespace terra::advisor

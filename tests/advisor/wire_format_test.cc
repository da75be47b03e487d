// Requests and replies of the four providers against what their own SDKs send
// and what servers answered (tests/data/providers).
#include "advisor/wire_format.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/advisor/golden_question.h"

namespace terra::advisor {
namespace {

using nlohmann::json;

struct Golden {
  std::string provider;
  std::string file;
  std::string path;
  std::string key_header;
};

class GoldenRequestTest : public ::testing::TestWithParam<Golden> {};
INSTANTIATE_TEST_SUITE_P(
    All, GoldenRequestTest,
    ::testing::Values(
        Golden{"openai", "openai-responses", "/v1/responses", "authorization"},
        Golden{"anthropic", "anthropic-messages", "/v1/messages", "x-api-key"},
        Golden{"gemini", "gemini-generateContent",
               "/v1beta/models/gemini-3.1-pro-preview:generateContent",
               "x-goog-api-key"},
        Golden{"chat", "openai-compatible-chat", "/v1/chat/completions",
               "authorization"}),
    [](const auto& tested) {
      return tested.param.provider;
    });

TEST_P(GoldenRequestTest, EqualsWhatTheSdkSends) {
  const json golden =
      json::parse(ProviderSample(GetParam().file + ".body.json"));
  const auto format = MakeWireFormat(GetParam().provider);
  GenerationSettings settings;
  settings.model = GetParam().provider == "chat"
                       ? golden.at("model").get<std::string>()
                       : std::string(format->default_model());
  const std::string question = QuestionIn(golden);
  ASSERT_FALSE(question.empty());
  EXPECT_EQ(format->Body(GoldenQuestion(question), settings), golden);
}

TEST_P(GoldenRequestTest, GoesToTheDocumentedPathWithOneKeyHeader) {
  const auto format = MakeWireFormat(GetParam().provider);
  GenerationSettings settings;
  settings.model = std::string(format->default_model());
  const std::string base(format->default_base_url());
  EXPECT_TRUE((base + format->Path(settings)).ends_with(GetParam().path))
      << base << format->Path(settings);
  int with_key = 0;
  for (const auto& [name, value] : format->Headers(settings, "KEY")) {
    if (value.find("KEY") == std::string::npos) continue;
    ++with_key;
    EXPECT_EQ(name, GetParam().key_header);
  }
  EXPECT_EQ(with_key, 1);
}

TEST(GeminiFormatTest, AModelMayBeNamedAsTheProviderListsIt) {
  const auto format = MakeGeminiFormat();
  GenerationSettings plain;
  plain.model = "gemini-x";
  GenerationSettings listed;
  listed.model = "models/gemini-x";
  EXPECT_EQ(format->Path(plain), "/v1beta/models/gemini-x:generateContent");
  EXPECT_EQ(format->Path(listed), format->Path(plain));
}

TEST_P(GoldenRequestTest, SamplingSettingsAreNeverSent) {
  const auto format = MakeWireFormat(GetParam().provider);
  const std::string body =
      format->Body(GoldenQuestion("q"), GenerationSettings{}).dump();
  for (const char* name : {"temperature", "top_p", "topP", "seed", "stream"}) {
    EXPECT_EQ(body.find(std::string("\"") + name + "\""), std::string::npos)
        << name;
  }
}

struct Reply {
  std::string name;
  std::string provider;
  std::string body;
  ReplyStatus status;
  std::string text;
};

class ReplyTest : public ::testing::TestWithParam<Reply> {};

const Reply kReplies[] = {
    {"openai_message", "openai", "@aimock-openai-responses.json",
     ReplyStatus::kAnswered, "No. [(2, 2), (2, 21), (21, 21)]"},
    {"anthropic_message", "anthropic", "@aimock-anthropic-messages.json",
     ReplyStatus::kAnswered, "No. [(2, 2), (2, 21), (21, 21)]"},
    {"gemini_message", "gemini", "@aimock-gemini-generateContent.json",
     ReplyStatus::kAnswered, "No. [(2, 2), (2, 21), (21, 21)]"},
    {"chat_message", "chat", "@aimock-openai-compatible-chat.json",
     ReplyStatus::kAnswered, "No. [(2, 2), (2, 21), (21, 21)]"},
    {"chat_truncated", "chat", "@llama-server-chat-length.json",
     ReplyStatus::kTruncated, "*"},
    {"anthropic_truncated", "anthropic", "@llama-server-messages.json",
     ReplyStatus::kTruncated, "*"},
    {"openai_local_server", "openai", "@llama-server-responses.json",
     ReplyStatus::kAnswered, "*"},
    {"openai_several_messages", "openai",
     R"({"status":"completed","output":[{"type":"reasoning","summary":[]},
         {"type":"message","content":[{"type":"output_text","text":"No. "}]},
         {"type":"message","content":[{"type":"output_text","text":"[(1, 2)]"}]}
         ]})",
     ReplyStatus::kAnswered, "No. [(1, 2)]"},
    {"openai_commentary_is_not_the_answer", "openai",
     R"({"status":"completed","output":[
         {"type":"message","phase":"commentary",
          "content":[{"type":"output_text","text":"Let me see."}]},
         {"type":"message","phase":"final_answer",
          "content":[{"type":"output_text","text":"Yes"}]}]})",
     ReplyStatus::kAnswered, "Yes"},
    {"openai_empty_and_truncated", "openai",
     R"({"status":"incomplete","incomplete_details":
         {"reason":"max_output_tokens"},"output":[{"type":"reasoning"}]})",
     ReplyStatus::kTruncated, ""},
    {"openai_content_filter", "openai",
     R"({"status":"incomplete","incomplete_details":
         {"reason":"content_filter"},"output":[]})",
     ReplyStatus::kRefused, ""},
    {"openai_refusal", "openai",
     R"({"status":"completed","output":[{"type":"message","content":[
         {"type":"refusal","refusal":"I cannot."}]}]})",
     ReplyStatus::kRefused, ""},
    {"anthropic_thinking_first", "anthropic",
     R"({"type":"message","stop_reason":"end_turn","content":[
         {"type":"thinking","thinking":"","signature":"x"},
         {"type":"redacted_thinking","data":"y"},
         {"type":"text","text":"Yes"}]})",
     ReplyStatus::kAnswered, "Yes"},
    {"anthropic_refusal_without_content", "anthropic",
     R"({"type":"message","stop_reason":"refusal","content":[]})",
     ReplyStatus::kRefused, ""},
    {"gemini_thought_is_not_the_answer", "gemini",
     R"({"candidates":[{"finishReason":"STOP","content":{"parts":[
         {"text":"hm","thought":true},{"text":"Yes","thoughtSignature":"s"}]}}]
         })",
     ReplyStatus::kAnswered, "Yes"},
    {"gemini_blocked_prompt", "gemini",
     R"({"promptFeedback":{"blockReason":"SAFETY"}})", ReplyStatus::kRefused,
     ""},
    {"gemini_safety", "gemini", R"({"candidates":[{"finishReason":"SAFETY"}]})",
     ReplyStatus::kRefused, ""},
    {"gemini_truncated_without_parts", "gemini",
     R"({"candidates":[{"finishReason":"MAX_TOKENS","content":{}}]})",
     ReplyStatus::kTruncated, ""},
    {"gemini_continuation_is_truncation", "gemini",
     R"({"candidates":[{"finishReason":"CONTINUATION","continuationToken":"t",
         "content":{"parts":[{"text":"No. [(1"}]}}]})",
     ReplyStatus::kTruncated, "*"},
    {"chat_content_filter", "chat",
     R"({"choices":[{"finish_reason":"content_filter",
         "message":{"content":null}}]})",
     ReplyStatus::kRefused, ""},
    {"chat_null_content", "chat",
     R"({"choices":[{"finish_reason":"stop","message":{"content":null}}]})",
     ReplyStatus::kAnswered, ""},
    {"chat_think_tags", "chat",
     R"({"choices":[{"finish_reason":"stop",
         "message":{"content":"<think>No?</think>\nYes"}}]})",
     ReplyStatus::kAnswered, "*"},
    {"html", "openai", "<html>busy</html>", ReplyStatus::kNoAnswer, ""},
    {"other_provider", "anthropic", R"({"choices":[]})", ReplyStatus::kNoAnswer,
     ""},
};
INSTANTIATE_TEST_SUITE_P(All, ReplyTest, ::testing::ValuesIn(kReplies),
                         [](const auto& tested) {
                           return tested.param.name;
                         });

TEST_P(ReplyTest, IsReadForWhatItIs) {
  const Reply& reply = GetParam();
  const std::string body = reply.body.front() == '@'
                               ? ProviderSample(reply.body.substr(1))
                               : reply.body;
  const WireReply read = MakeWireFormat(reply.provider)->ReadReply(body);
  EXPECT_EQ(read.status, reply.status) << read.error;
  if (reply.text != "*") {
    EXPECT_EQ(read.text, reply.text);
  }
}

TEST(WireFormatTest, ThinkingOfALocalModelIsNotPartOfItsAnswer) {
  const WireReply read = MakeChatFormat()->ReadReply(
      R"({"choices":[{"finish_reason":"stop",
          "message":{"content":"<think>No. [(1, 1)]</think>\n\nYes"}}]})");
  EXPECT_EQ(read.text.find("think"), std::string::npos);
  EXPECT_NE(read.text.find("Yes"), std::string::npos);
}

TEST(WireFormatTest, UsedUpQuotasAreFinal) {
  EXPECT_TRUE(MakeOpenAiFormat()
                  ->ReadError(R"({"error":{"message":"m",
                               "code":"insufficient_quota"}})")
                  .final);
  EXPECT_TRUE(MakeAnthropicFormat()
                  ->ReadError(R"({"type":"error","error":{
                               "type":"rate_limit_error","message":"m",
                               "details":{"error_code":
                               "enforced_spend_limit_reached"}}})")
                  .final);
  const WireError gemini = MakeGeminiFormat()->ReadError(
      R"({"error":{"code":429,"message":"m","details":[
          {"@type":"type.googleapis.com/google.rpc.RetryInfo",
           "retryDelay":"22s"}]}})");
  EXPECT_FALSE(gemini.final);
  EXPECT_EQ(gemini.retry_after_s, 22);
}

TEST(WireFormatTest, ReadsAnyBytesWithoutThrowing) {
  const std::string good = ProviderSample("aimock-anthropic-messages.json");
  for (const char* provider : {"openai", "gemini", "anthropic", "chat"}) {
    const auto format = MakeWireFormat(provider);
    for (std::size_t cut = 0; cut < good.size(); ++cut) {
      EXPECT_FALSE(format->ReadReply(good.substr(0, cut)).status ==
                   ReplyStatus::kAnswered);
    }
    for (const char* odd :
         {"null", "[]", "{}", "\"x\"", R"({"output":{}})",
          R"({"choices":[{}]})", R"({"content":[{"type":"text"}]})", "\xff\xfe",
          ""}) {
      EXPECT_EQ(format->ReadReply(odd).status == ReplyStatus::kAnswered, false)
          << provider << " " << odd;
      format->ReadError(odd);
    }
  }
}

}  // namespace
}  // namespace terra::advisor

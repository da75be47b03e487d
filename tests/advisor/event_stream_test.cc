// Servers that stream what nobody asked them to stream.
#include "advisor/event_stream.h"

#include <map>
#include <string>
#include <tuple>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/advisor/golden_question.h"
#include "tests/advisor/provider_calls.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t CountEvents(std::string_view body) {
  const auto events = ReadEventStream(body);
  return events ? events->size() : 99;
}

TEST(EventStreamTest, IsToldFromJson) {
  for (const char* stream : {"data: {}", "event: x\ndata: {}\n\n", ": hm\n\n",
                             "\r\n\r\ndata:{}", "id: 1\n", "retry: 5\n"}) {
    EXPECT_TRUE(IsEventStream(stream)) << stream;
  }
  for (const char* other : {"", "{}", "[]", "<html>", "database", "\n\n"}) {
    EXPECT_FALSE(IsEventStream(other)) << other;
  }
}

TEST(EventStreamTest, LinesMayEndInAllThreeWays) {
  for (const char* body :
       {"data: {}\n\ndata: {}\n\n", "data: {}\r\n\r\ndata: {}\r\n\r\n",
        "data: {}\r\rdata: {}\r\r", "data:{}\n\ndata:{}"}) {
    EXPECT_EQ(CountEvents(body), 2u) << body;
  }
}

TEST(EventStreamTest, OnlyJsonObjectsInDataCount) {
  const auto events = ReadEventStream(
      ": a comment\nid: 7\nevent: a\ndata: {\"a\":\ndata: 1}\n\n"
      "data: [DONE]\n\ndata: {\"b\n\ndata: \xff\n\ndata\n\nnonsense\n\n");
  ASSERT_TRUE(events);
  ASSERT_EQ(events->size(), 1u);
  EXPECT_EQ(events->front(), nlohmann::json({{"a", 1}}));
}

TEST(EventStreamTest, MoreEventsThanAnAnswerNeedsAreNotRead) {
  std::string body;
  for (int i = 0; i < 100'001; ++i) body += "data:{}\n\n";
  EXPECT_FALSE(ReadEventStream(body));
}

/// "Yes" as each provider streams it, after its documents.
const std::map<std::string, std::string>& Streams() {
  static const std::map<std::string, std::string> kStreams = {
      {"openai", R"(event: response.created
data: {"type":"response.created","response":{"id":"r1","model":"scripted","status":"in_progress","output":[]}}

event: response.output_text.delta
data: {"type":"response.output_text.delta","delta":"Yes"}

event: response.completed
data: {"type":"response.completed","response":{"id":"r1","model":"scripted","status":"completed","error":null,"output":[{"type":"message","content":[{"type":"output_text","text":"Yes"}]}],"usage":{"input_tokens":1000,"output_tokens":20}}}

)"},
      {"anthropic", R"(event: message_start
data: {"type":"message_start","message":{"id":"m1","model":"scripted","content":[],"stop_reason":null,"usage":{"input_tokens":1000,"output_tokens":1}}}

event: content_block_start
data: {"type":"content_block_start","index":0,"content_block":{"type":"thinking","thinking":""}}

event: content_block_delta
data: {"type":"content_block_delta","index":0,"delta":{"type":"thinking_delta","thinking":"No?"}}

event: ping
data: {"type":"ping"}

event: content_block_start
data: {"type":"content_block_start","index":1,"content_block":{"type":"text","text":""}}

event: content_block_delta
data: {"type":"content_block_delta","index":1,"delta":{"type":"text_delta","text":"Ye"}}

event: content_block_delta
data: {"type":"content_block_delta","index":1,"delta":{"type":"text_delta","text":"s"}}

event: message_delta
data: {"type":"message_delta","delta":{"stop_reason":"end_turn","stop_sequence":null},"usage":{"input_tokens":null,"output_tokens":20}}

event: message_stop
data: {"type":"message_stop"}

)"},
      {"gemini",
       R"(data: {"candidates":[{"content":{"role":"model","parts":[{"text":"No?","thought":true},{"text":"Ye"}]},"index":0}],"modelVersion":"scripted"}

data: {"candidates":[{"content":{"role":"model","parts":[{"text":"s"}]},"finishReason":"STOP","index":0}],"usageMetadata":{"promptTokenCount":1000,"candidatesTokenCount":20},"modelVersion":"scripted"}

)"},
      {"chat",
       R"(data: {"id":"c1","model":"scripted","choices":[{"index":0,"delta":{"role":"assistant","content":null},"finish_reason":null}],"error":null}

data: {"id":"c1","model":"scripted","choices":[{"index":0,"delta":{"reasoning_content":"No?"}}]}

data: {"id":"c1","model":"scripted","choices":[{"index":0,"delta":{"content":"Ye"}}]}

data: {"id":"c1","model":"scripted","choices":[{"index":0,"delta":{"content":"s"}}],"usage":null}

data: {"id":"c1","model":"scripted","choices":[{"index":0,"delta":{},"finish_reason":"stop"}]}

data: {"id":"c1","model":"scripted","choices":[],"usage":{"prompt_tokens":1000,"completion_tokens":20}}

data: [DONE]

)"}};
  return kStreams;
}

ScriptedReply Streamed(const std::string& body) {
  ScriptedReply reply;
  reply.content_type = "text/event-stream";
  reply.framing = testing::Framing::kUntilClose;
  reply.body = body;
  return reply;
}

class StreamedReplyTest : public EveryProviderTest {};
INSTANTIATE_TEST_SUITE_P(All, StreamedReplyTest,
                         ::testing::Values("openai", "gemini", "anthropic",
                                           "chat"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(StreamedReplyTest, IsReadAsIfItHadComeAtOnce) {
  ScriptedLlmServer server({Streamed(Streams().at(GetParam()))});
  const LlmReply reply = Client(GetParam(), server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.status, ReplyStatus::kAnswered) << reply.error;
  EXPECT_EQ(reply.text, "Yes");
  EXPECT_EQ(reply.model, "scripted");
  EXPECT_EQ(reply.usage.tokens_in, 1000);
  EXPECT_EQ(reply.usage.tokens_out, 20);
  EXPECT_EQ(reply.tries, 1);
}

// Where the connection's end ends the body, nothing else tells of the cut.
TEST_P(StreamedReplyTest, WithoutItsEndItIsAskedForAgain) {
  const std::string& whole = Streams().at(GetParam());
  ScriptedLlmServer server(
      {Streamed(whole.substr(0, whole.size() / 3)), Streamed(whole)});
  const LlmReply reply = Client(GetParam(), server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.text, "Yes") << reply.error;
  EXPECT_EQ(reply.tries, 2);
}

TEST_P(StreamedReplyTest, CutAnywhereItIsWholeOrNothing) {
  const auto format = MakeWireFormat(GetParam());
  const std::string& stream = Streams().at(GetParam());
  int with_end = 0;
  for (std::size_t size = 6; size <= stream.size(); ++size) {
    const auto whole = format->Whole(stream.substr(0, size));
    if (!whole) continue;
    ++with_end;
    EXPECT_EQ(format->ReadReply(*whole).text, "Yes") << size;
  }
  EXPECT_GT(with_end, 0);
  EXPECT_LT(with_end, 200) << "what comes before the end is no answer";
}

TEST_P(StreamedReplyTest, AnErrorInItIsTheReply) {
  const std::string error =
      "data: {\"type\":\"error\",\"error\":{\"code\":400,"
      "\"message\":\"no such model\"}}\n\n";
  const std::string& whole = Streams().at(GetParam());
  ScriptedLlmServer server(
      {Streamed(error),
       Streamed(whole.substr(0, whole.size() / 3) + "\n\n" + error)});
  auto client = Client(GetParam(), server.url());
  for (int call = 0; call < 2; ++call) {
    const LlmReply reply = client->Ask(Question(), {});
    EXPECT_EQ(reply.reason, NoAnswer::kBadReply);
    EXPECT_THAT(reply.error, HasSubstr("no such model"));
  }
}

TEST_P(StreamedReplyTest, AKeyIsCutOutOfItEvenInPieces) {
  const auto format = MakeWireFormat(GetParam());
  setenv(std::string(format->key_variable()).c_str(), kSecret, 1);
  std::string body = Streams().at(GetParam());
  const std::string secret = kSecret;
  for (const auto& [piece, part] :
       {std::pair<std::string, std::string>{"\"Ye\"", secret.substr(0, 7)},
        {"\"s\"", secret.substr(7)},
        {"\"Yes\"", secret}}) {
    const std::size_t at = body.rfind(piece);
    if (at != std::string::npos) {
      body.replace(at, piece.size(), "\"" + part + "\"");
    }
  }
  ScriptedLlmServer server({Streamed(body)});
  auto client = Client(GetParam(), server.url());
  unsetenv(std::string(format->key_variable()).c_str());
  const LlmReply reply = client->Ask(Question(), {});
  EXPECT_EQ(reply.text, "[key]") << reply.error;
  EXPECT_THAT(reply.body, HasSubstr("[key]"));
  EXPECT_THAT(reply.body, Not(HasSubstr(secret.substr(7))));
}

/// Streams that llama.cpp's server sent when it was asked for them.
TEST(StreamsOfALocalServer, AreReadInAllItsForms) {
  for (const auto& [provider, form, tokens_in, status] :
       {std::tuple{"chat", "chat", 132, ReplyStatus::kTruncated},
        {"anthropic", "messages", 132, ReplyStatus::kTruncated},
        {"openai", "responses", 132, ReplyStatus::kAnswered}}) {
    SCOPED_TRACE(form);
    const auto format = MakeWireFormat(provider);
    const auto whole = format->Whole(
        ProviderSample(std::string("llama-server-") + form + "-stream.txt"));
    ASSERT_TRUE(whole);
    const WireReply reply = format->ReadReply(*whole);
    EXPECT_EQ(reply.status, status) << "it does not tell responses' truncation";
    EXPECT_FALSE(reply.text.empty());
    EXPECT_EQ(reply.model, "local-model");
    EXPECT_EQ(reply.usage.tokens_in, tokens_in);
    EXPECT_EQ(reply.usage.tokens_out, 4);
  }
}

TEST(StreamedOpenAiTest, AnErrorWithoutAnObjectOfThatNameIsOne) {
  const auto whole = MakeOpenAiFormat()->Whole(
      "data: {\"type\":\"error\",\"code\":\"x\",\"message\":\"too bad\"}\n\n");
  ASSERT_TRUE(whole);
  EXPECT_THAT(MakeOpenAiFormat()->ReadReply(*whole).error,
              HasSubstr("too bad"));
}

TEST(StreamedGeminiTest, ABlockedPromptIsARefusal) {
  const auto whole = MakeGeminiFormat()->Whole(
      "data: {\"promptFeedback\":{\"blockReason\":\"SAFETY\"}}\n\n");
  ASSERT_TRUE(whole);
  EXPECT_EQ(MakeGeminiFormat()->ReadReply(*whole).status,
            ReplyStatus::kRefused);
  EXPECT_FALSE(MakeGeminiFormat()->Whole(
      "data: {\"promptFeedback\":{},\"candidates\":[{\"content\":{\"parts\":"
      "[{\"text\":\"No. [(1, 2)\"}]}}]}\n\n"))
      << "cut, not blocked";
}

}  // namespace
}  // namespace terra::advisor

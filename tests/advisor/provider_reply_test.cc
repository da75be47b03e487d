// Replies in the ways in which servers, those that imitate a provider too, send
// them.
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "advisor/answer_parser.h"
#include "tests/advisor/provider_calls.h"

namespace terra::advisor {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ProviderAnswerTest : public EveryProviderTest {};
INSTANTIATE_TEST_SUITE_P(All, ProviderAnswerTest,
                         ::testing::Values("openai", "gemini", "anthropic",
                                           "chat"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(ProviderAnswerTest, AnswerModelAndTokensAreReadFromTheReply) {
  ScriptedLlmServer server({Good(GetParam(), "No. [(1, 2), (3, 4)]")});
  const LlmReply reply = Client(GetParam(), server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.status, ReplyStatus::kAnswered) << reply.error;
  EXPECT_EQ(reply.text, "No. [(1, 2), (3, 4)]");
  EXPECT_EQ(reply.model, "scripted");
  EXPECT_EQ(reply.usage.tokens_in, 1000);
  EXPECT_EQ(reply.usage.tokens_out, 20);
  EXPECT_EQ(reply.tries, 1);
}

TEST_P(ProviderAnswerTest, TheVersionMayStandAtTheEndOfTheBaseAddress) {
  ScriptedLlmServer server({Good(GetParam())});
  for (const char* end : {"", "/", "/v1", "/v1/", "/v1beta", "/v1beta//"}) {
    Client(GetParam(), server.url() + end)->Ask(Question(), {});
  }
  const auto seen = server.requests();
  ASSERT_EQ(seen.size(), 6u);
  for (const auto& request : seen) EXPECT_EQ(request.path, seen[0].path);
}

TEST_P(ProviderAnswerTest, EveryFramingOfTheBodyIsRead) {
  for (const auto framing :
       {testing::Framing::kChunked, testing::Framing::kUntilClose}) {
    ScriptedReply reply = Good(GetParam());
    reply.framing = framing;
    reply.content_type = "";
    ScriptedLlmServer server({reply});
    const LlmReply read = Client(GetParam(), server.url())->Ask(Question(), {});
    EXPECT_EQ(read.text, "Yes") << read.error;
    EXPECT_EQ(read.tries, 1);
  }
}

// Servers end idle connections; the next call finds a dead one in its hand.
TEST_P(ProviderAnswerTest, AConnectionThatTheServerClosedIsNoFailure) {
  ScriptedReply reply = Good(GetParam());
  reply.close_after = true;
  ScriptedLlmServer server({reply});
  auto client = Client(GetParam(), server.url());
  for (int i = 0; i < 5; ++i) {
    const LlmReply read = client->Ask(Question(), {});
    EXPECT_EQ(read.text, "Yes") << read.error;
    EXPECT_EQ(read.tries, 1);
  }
}

TEST(ProviderReplyTest, AChunkedBodyThatIsCutIsAskedForAgain) {
  ScriptedReply cut = Good("chat");
  cut.framing = testing::Framing::kChunked;
  cut.body_share = 0.5;
  ScriptedLlmServer server({cut, Good("chat")});
  const LlmReply reply = Client("chat", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.text, "Yes") << reply.error;
  EXPECT_EQ(reply.tries, 2);
}

// The least that imitations of the four forms send.
TEST_P(ProviderAnswerTest, FieldsThatDecideNothingMayBeMissing) {
  const std::map<std::string, std::vector<std::string>> bodies = {
      {"openai",
       {R"({"output":[{"type":"message","content":"Yes"}]})",
        R"({"output":[{"type":"message","content":[
            {"type":"text","text":"Yes"}]}]})",
        R"({"status":"completed","output":[],"output_text":"Yes"})",
        R"({"output_text":"Yes","usage":null,"error":null,"more":{}})"}},
      {"anthropic",
       {R"({"content":"Yes"})", R"({"content":[{"type":"text","text":"Yes"}]})",
        R"({"content":[{"type":"text","text":"Yes"}],"stop_reason":null,
            "usage":{"input_tokens":null,"output_tokens":1.5}})"}},
      {"gemini",
       {R"({"candidates":[{"content":{"parts":[{"text":"Yes"}]}}]})",
        R"({"candidates":[{"finishReason":"stop",
            "content":{"parts":[{"text":"Yes"}]}}]})"}},
      {"chat",
       {R"({"choices":[{"message":{"content":"Yes"}}]})",
        R"({"choices":[{"message":{"role":"assistant","content":[
            {"type":"thinking","thinking":[]},
            {"type":"text","text":"Yes"}]},"finish_reason":null}]})",
        R"({"choices":[{"message":{"content":"Yes","refusal":null,
            "reasoning_content":"No?","tool_calls":[]},"logprobs":null}],
            "error":null,"timings":{"n":1},"usage":{}})"}}};
  for (const std::string& body : bodies.at(GetParam())) {
    const WireReply read = MakeWireFormat(GetParam())->ReadReply(body);
    EXPECT_EQ(read.status, ReplyStatus::kAnswered) << body << read.error;
    EXPECT_EQ(read.text, "Yes") << body;
  }
}

TEST_P(ProviderAnswerTest,
       AnErrorInsideASuccessIsNamedAndAskedAgainIfItMayPass) {
  ScriptedReply busy;
  busy.body = R"({"error":{"code":503,"message":"no instance"}})";
  ScriptedReply wrong;
  wrong.body = R"({"error":{"code":400,"message":"no such model"}})";
  ScriptedLlmServer server({busy, Good(GetParam()), wrong});
  auto client = Client(GetParam(), server.url());
  EXPECT_EQ(client->Ask(Question(), {}).tries, 2);
  const LlmReply reply = client->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kBadReply);
  EXPECT_THAT(reply.error, HasSubstr("no such model"));
}

TEST_P(ProviderAnswerTest, WhatAModelThoughtIsNoAnswer) {
  for (const char* said :
       {"No. [(1, 1), (9, 9)] hits a wall.\n</think>\n\nYes",
        "<think>No. [(1, 1), (9, 9)]</think>Yes",
        "<think>a</think>No.<think>b</think>\nYes", "hm</THINK> Yes",
        "hm</thinking>Yes", "[THINK]hm[/THINK]Yes", "hm</seed:think>Yes",
        "<|channel|>analysis<|message|>hm<|end|><|start|>assistant"
        "<|channel|>final<|message|>Yes"}) {
    const WireReply read =
        MakeWireFormat(GetParam())->ReadReply(ReplyBody(GetParam(), said));
    EXPECT_EQ(read.status, ReplyStatus::kAnswered) << read.error;
    EXPECT_EQ(ParseAnswer(read.text).kind, AnswerKind::kRetain) << read.text;
  }
  for (const char* unfinished : {"<think>Yes", "</think> <think>Yes"}) {
    const WireReply read = MakeWireFormat(GetParam())
                               ->ReadReply(ReplyBody(GetParam(), unfinished));
    EXPECT_EQ(read.text, "") << unfinished;
    EXPECT_THAT(read.error, HasSubstr("--max-output-tokens"));
  }
}

TEST_P(ProviderAnswerTest, ThinkingWithoutAnAnswerIsExplained) {
  const std::map<std::string, std::string> bodies = {
      {"openai", R"({"status":"completed","output":[{"type":"reasoning"},
          {"type":"message","content":[]}]})"},
      {"anthropic", R"({"stop_reason":"end_turn","content":[
          {"type":"thinking","thinking":"hm"}]})"},
      {"gemini", R"({"candidates":[{"finishReason":"STOP","content":{"parts":[
          {"text":"hm","thought":true}]}}]})"},
      {"chat", R"({"choices":[{"finish_reason":"stop","message":{
          "content":"","reasoning_content":"hm"}}]})"}};
  const WireReply read =
      MakeWireFormat(GetParam())->ReadReply(bodies.at(GetParam()));
  EXPECT_EQ(read.status, ReplyStatus::kAnswered) << "an attempt all the same";
  EXPECT_EQ(read.text, "");
  EXPECT_THAT(read.error, HasSubstr("thought and gave no answer"));
}

TEST_P(ProviderAnswerTest, NoReplyShowsTheMarksOfTheJsonLibrary) {
  const auto format = MakeWireFormat(GetParam());
  for (const char* body :
       {R"({"choices":[]})",
        R"({"choices":{}})",
        R"({"choices":[{}]})",
        R"({"choices":[{"message":null}]})",
        R"({"choices":null})",
        R"({"choices":[{"message":{"content":[1]}}]})",
        R"({"choices":[{"message":{"content":[{"type":1}]}}]})",
        R"({"choices":["x"]})",
        R"({"content":null})",
        R"({"content":7})",
        R"({"content":[{}]})",
        R"({"content":["x"]})",
        R"({"content":[{"type":"text","text":null}]})",
        R"({"output":[{"type":"message"}]})",
        R"({"output":7})",
        R"({"output":[{"type":"message","content":[{"type":"text"}]}]})",
        R"({"candidates":[]})",
        R"({"candidates":7})",
        "{}",
        "[]",
        "7",
        "{",
        "",
        R"({"output":["x"]})",
        R"({"status":"completed","output":null})"}) {
    const WireReply read = format->ReadReply(body);
    EXPECT_THAT(read.error, Not(HasSubstr("json.exception"))) << body;
    EXPECT_EQ(read.came(), read.error.empty()) << body;
  }
}

TEST(ProviderReplyTest, AFailureInPlaceOfTheAnswerIsNoAnswerAndAskedAgain) {
  ScriptedReply failing;
  failing.body = R"({"id":"g1","choices":[{"finish_reason":"error","error":{
      "code":502,"message":"Provider returned error"},
      "message":{"role":"assistant","content":"No. [(1, 2), (3"}}]})";
  ScriptedReply amid;
  amid.body = R"({"choices":[{"finish_reason":"error",
      "message":{"role":"assistant","content":"No"}}]})";
  ScriptedLlmServer server({failing, amid, Good("chat")});
  const LlmReply reply = Client("chat", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.text, "Yes") << reply.error;
  EXPECT_EQ(reply.tries, 3);

  ScriptedReply refused;
  refused.body = R"({"choices":[{"error":{"code":400,"message":"bad picture"},
      "message":{"role":"assistant","content":""}}]})";
  ScriptedLlmServer final_one({refused});
  const LlmReply none = Client("chat", final_one.url())->Ask(Question(), {});
  EXPECT_EQ(none.status, ReplyStatus::kNoAnswer);
  EXPECT_EQ(none.tries, 1);
  EXPECT_EQ(none.error, "400: bad picture");
}

TEST(ProviderReplyTest, AStreamsFailureInPlaceOfTheAnswerIsNoAnswer) {
  const auto format = MakeChatFormat();
  const auto whole = format->Whole(
      "data: {\"choices\":[{\"delta\":{\"content\":\"No\"}}]}\n\n"
      "data: {\"choices\":[{\"delta\":{},\"error\":{\"code\":429,"
      "\"message\":\"slow down\"}}]}\n\n");
  ASSERT_TRUE(whole);
  const WireReply read = format->ReadReply(*whole);
  EXPECT_EQ(read.status, ReplyStatus::kNoAnswer);
  EXPECT_TRUE(read.transient);
  EXPECT_EQ(read.error, "429: slow down");
}

TEST_P(ProviderAnswerTest, AFailureThatMayPassIsKnownByItsWordToo) {
  const auto format = MakeWireFormat(GetParam());
  for (const char* passing :
       {R"({"type":"error","error":{"type":"overloaded_error","message":"m"}})",
        R"({"error":{"status":"UNAVAILABLE","message":"m"}})",
        R"({"error":{"code":"rate_limit_exceeded","message":"m"}})",
        R"({"error":{"code":"503","message":"m"}})"}) {
    const WireReply read = format->ReadReply(passing);
    EXPECT_TRUE(read.transient) << passing;
    EXPECT_FALSE(read.came()) << passing;
  }
  for (const char* lasting :
       {R"({"error":{"type":"invalid_request_error","message":"m"}})",
        R"({"error":{"code":400,"type":"server_error","message":"m"}})",
        R"({"error":true,"message":"m"})", R"({"error":"m"})"}) {
    const WireReply read = format->ReadReply(lasting);
    EXPECT_FALSE(read.transient) << lasting;
    EXPECT_FALSE(read.came()) << lasting;
    EXPECT_THAT(read.error, ::testing::EndsWith("m")) << lasting;
  }
}

TEST(ProviderReplyTest, OnlyAForeignFormRaisesTheQuestionOfTheAddress) {
  ScriptedReply limited;
  limited.body = R"({"error":{"code":429,"message":"rate limit"}})";
  limited.headers = {{"retry-after-ms", "1"}};
  ScriptedReply foreign;
  foreign.body = R"({"answer":"Yes"})";
  ScriptedLlmServer busy({limited});
  ScriptedLlmServer other({foreign});
  const std::string limit =
      Client("chat", busy.url())->Ask(Question(), {}).error;
  EXPECT_THAT(limit, HasSubstr("429: rate limit"));
  EXPECT_THAT(limit, HasSubstr("asked 4 times"));
  EXPECT_THAT(limit, Not(HasSubstr("speak this backend's form")));
  EXPECT_THAT(Client("chat", other.url())->Ask(Question(), {}).error,
              HasSubstr("speak this backend's form"));
}

TEST(ProviderReplyTest, TheReasonIsFoundInEveryFormOfError) {
  for (const std::string body :
       {R"({"error":{"message":"the reason"}})", R"({"error":"the reason"})",
        R"([{"error":{"message":"the reason"}}])",
        R"({"object":"error","message":"the reason"})",
        R"({"detail":"the reason"})",
        R"({"detail":[{"loc":["body"],"msg":"the reason"}]})",
        "\r\nthe reason\nand more", "the reason"}) {
    ScriptedReply scripted = Failing(400);
    scripted.body = body;
    ScriptedLlmServer server({scripted});
    const LlmReply reply = Client("chat", server.url())->Ask(Question(), {});
    EXPECT_EQ(reply.error, "HTTP 400: the reason") << body;
  }
}

struct LocalServerError {
  int status;
  std::string body;
  int tries;
  std::string said;
};

// Errors of llama.cpp's server, as it sent them to questions of ours.
TEST(ProviderReplyTest, ErrorsOfALocalModelServerAreToldAsTheyAre) {
  const std::vector<LocalServerError> errors = {
      {503,
       R"({"error":{"message":"Loading model","type":"unavailable_error",
           "code":503}})",
       2, "HTTP 503: Loading model"},
      {500,
       R"({"error":{"code":500,"message":"image input is not supported - hint: )"
       R"(if this is unexpected, you may need to provide the mmproj",)"
       R"("type":"server_error"}})",
       2, "you may need to provide the mmproj"},
      {501,
       R"({"error":{"code":501,"message":"not supported",
           "type":"not_supported_error"}})",
       1, "HTTP 501: not supported"},
      {400,
       R"({"error":{"code":400,"message":"request (4228 tokens) exceeds the )"
       R"(available context size (1024 tokens), try increasing it","type":)"
       R"("exceed_context_size_error","n_prompt_tokens":4228,"n_ctx":1024}})",
       1, "exceeds the available context size"},
      {404,
       R"({"error":{"message":"File Not Found","type":"not_found_error",
           "code":404}})",
       1, "check --base-url"},
      {401,
       R"({"error":{"message":"Invalid API Key","type":"authentication_error",
           "code":401}})",
       1, "set the environment variable"}};
  for (const std::string provider : {"chat", "openai", "anthropic"}) {
    for (const LocalServerError& error : errors) {
      ScriptedReply scripted;
      scripted.status = error.status;
      scripted.body = error.body;
      scripted.headers = {{"retry-after-ms", "1"}};
      ScriptedLlmServer server({scripted});
      ProviderOptions options;
      options.base_url = server.url();
      options.retry.max_retries = 1;
      auto client = ProviderClient::Create(provider, options);
      ASSERT_TRUE(client.ok());
      const LlmReply reply = (*client)->Ask(Question(), {});
      EXPECT_EQ(reply.reason, NoAnswer::kHttpStatus);
      EXPECT_EQ(reply.tries, error.tries) << error.body;
      EXPECT_THAT(reply.error, HasSubstr(error.said));
    }
  }
}

// Copying and writing JSON recurse: what is nested deeply must not get there.
TEST(ProviderReplyTest, DeepNestingIsNoAnswerAndExhaustsNoStack) {
  const std::string open(3'000'000, '[');
  const std::string close(3'000'000, ']');
  ScriptedReply inside = Good("chat");
  inside.body.insert(1, R"("a":")"
                        "\\/"
                        R"(","b":)" +
                            open + close + ",");
  ScriptedReply around = Failing(400);
  around.body = open + R"({"error":{"message":"x"}})" + close;
  ScriptedReply stream = Good("chat");
  stream.body = "data: " + inside.body + "\n\n";
  ScriptedLlmServer server({inside, around, stream, Good("chat")});
  auto client = Client("chat", server.url());
  EXPECT_EQ(client->Ask(Question(), {}).reason, NoAnswer::kBadReply);
  EXPECT_EQ(client->Ask(Question(), {}).reason, NoAnswer::kHttpStatus);
  const LlmReply reply = client->Ask(Question(), {});
  EXPECT_EQ(reply.text, "Yes") << "the stream had no end: asked again";
  EXPECT_EQ(reply.tries, 2);
  const std::string sixty = std::string(60, '[') + std::string(60, ']');
  EXPECT_EQ(MakeChatFormat()
                ->ReadReply("{\"a\":\"[[[[{\\\"[\",\"b\":" + sixty +
                            R"(,"choices":[{"message":{"content":"Yes"}}]})")
                .text,
            "Yes");
}

TEST(ProviderReplyTest, AWrongContentTypeDoesNotMatter) {
  ScriptedReply odd = Good("openai");
  odd.content_type = "text/html; charset=latin1";
  ScriptedLlmServer server({odd});
  EXPECT_EQ(Client("openai", server.url())->Ask(Question(), {}).text, "Yes");
}

TEST(ProviderReplyTest, BodiesThatAreNoReplyAreNoAnswer) {
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

TEST(ProviderReplyTest, HugeBodiesAreCutOff) {
  ScriptedReply huge;
  huge.body = std::string(16u << 20, ' ');
  ScriptedLlmServer server({huge});
  const LlmReply reply = Client("openai", server.url())->Ask(Question(), {});
  EXPECT_EQ(reply.reason, NoAnswer::kTooLarge);
  EXPECT_EQ(reply.tries, 1);
}

TEST(ProviderReplyTest, LargeRequestsDoNotWaitForPermission) {
  ScriptedLlmServer server({Good("openai")});
  LlmRequest request = Question();
  request.text.assign(3u << 20, 'x');
  const LlmReply reply = Client("openai", server.url())->Ask(request, {});
  EXPECT_EQ(reply.text, "Yes") << reply.error;
  EXPECT_EQ(server.requests().front().Header("expect"), "");
}

}  // namespace
}  // namespace terra::advisor

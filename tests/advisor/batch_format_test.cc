// Batch files against those of the providers' SDKs (tests/data/providers).
#include "advisor/batch_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "terrain/files/whole_file.h"
#include "tests/advisor/golden_question.h"

namespace terra::advisor {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json ItemFor(const std::string& provider, const json& golden_body) {
  const auto format = MakeWireFormat(provider);
  GenerationSettings settings;
  settings.model = std::string(format->default_model());
  return json::parse(BatchItem(
      *format, "case-0001", GoldenQuestion(QuestionIn(golden_body)), settings));
}

std::vector<BatchResult> Read(const std::string& provider,
                              const std::string& file) {
  std::istringstream lines(ProviderSample(file));
  std::vector<BatchResult> results;
  for (std::string line; std::getline(lines, line);) {
    const auto result = ReadBatchResult(*MakeWireFormat(provider), line);
    EXPECT_TRUE(result.ok()) << line;
    if (result.ok()) results.push_back(*result);
  }
  return results;
}

TEST(BatchFormat, OpenAiItemsEqualTheSdks) {
  const json golden = json::parse(ProviderSample("openai-batch-input.jsonl"));
  EXPECT_EQ(ItemFor("openai", golden.at("body")), golden);
}

TEST(BatchFormat, AnthropicItemsEqualTheSdks) {
  const json golden =
      json::parse(ProviderSample("anthropic-batch-create.body.json"));
  const json item = ItemFor("anthropic", golden.at("requests").at(0));
  EXPECT_EQ(item, golden.at("requests").at(0));
  const BatchForm& form = *FindBatchForm("anthropic");
  EXPECT_EQ(json::parse(std::string(form.head) + item.dump() +
                        std::string(form.tail)),
            golden);
}

TEST(BatchFormat, GeminiRequestsEqualTheSdks) {
  const json golden =
      json::parse(ProviderSample("gemini-batch-create-inline.body.json"))
          .at("/batch/inputConfig/requests/requests/0"_json_pointer);
  const json item = ItemFor("gemini", golden.at("request"));
  EXPECT_EQ(item.at("request"), golden.at("request"));
  EXPECT_EQ(item.at("key"), golden.at("/metadata/key"_json_pointer));
}

TEST(BatchFormat, ReadsTheProvidersResultFiles) {
  const auto openai = Read("openai", "openai-batch-output.jsonl");
  ASSERT_EQ(openai.size(), 1u);
  EXPECT_EQ(openai[0].id, "case-0001");
  EXPECT_EQ(openai[0].reply.text, "Yes");
  EXPECT_FALSE(openai[0].reply.timed);
  const auto anthropic = Read("anthropic", "anthropic-batch-results.jsonl");
  ASSERT_EQ(anthropic.size(), 3u);
  EXPECT_EQ(anthropic[0].reply.text, "Yes");
  EXPECT_EQ(anthropic[0].reply.model, "claude-opus-4-8");
  EXPECT_FALSE(anthropic[1].reply.came());
  EXPECT_EQ(anthropic[1].reply.error, "m");
  EXPECT_EQ(anthropic[2].reply.error, "expired");
}

TEST(BatchFormat, RefusalsAndTruncationsAreAnswersAsInACall) {
  const auto format = MakeWireFormat("anthropic");
  const auto refused = ReadBatchResult(
      *format,
      R"({"custom_id":"a","result":{"type":"succeeded","message":
          {"content":[],"stop_reason":"refusal"}}})");
  ASSERT_TRUE(refused.ok());
  EXPECT_EQ(refused->reply.status, ReplyStatus::kRefused);
  const auto cut = ReadBatchResult(
      *format,
      R"({"custom_id":"a","result":{"type":"succeeded","message":
          {"content":[],"stop_reason":"max_tokens"}}})");
  ASSERT_TRUE(cut.ok());
  EXPECT_EQ(cut->reply.status, ReplyStatus::kTruncated);
}

TEST(BatchFormat, AnyOtherLineIsAnError) {
  for (const char* provider : {"openai", "anthropic", "gemini"}) {
    const auto format = MakeWireFormat(provider);
    for (const char* line :
         {"", "{", "[]", "null", "1", "{}", "{\"custom_id\":1,\"key\":1}",
          "{\"custom_id\":\"a\",\"key\":\"a\"}", "\xff\xfe",
          "{\"custom_id\":\"a\",\"response\":{\"status_code\":\"x\"}}"}) {
      EXPECT_FALSE(ReadBatchResult(*format, line).ok()) << provider << line;
    }
  }
}

TEST(BatchFormat, AStatusThatIsNoIntIsAnError) {
  const auto format = MakeWireFormat("openai");
  for (const char* status :
       {"4e45", "2147483648", "-2147483649", "200.5", "18446744073709551615",
        "4444444444444444444444444444444444444444"}) {
    const std::string line = R"({"custom_id":"a","response":{"status_code":)" +
                             std::string(status) + R"(,"body":{}}})";
    EXPECT_FALSE(ReadBatchResult(*format, line).ok()) << status;
  }
}

TEST(BatchFormat, IdsAreWhatAllProvidersAccept) {
  const std::string id = BatchId(std::string(32, 'a'), 12);
  EXPECT_LE(id.size(), 64u);
  EXPECT_EQ(id.find_first_not_of("abcdef0123456789-"), std::string::npos);
}

TEST(BatchFormat, NoLineShowsTheMarksOfTheJsonLibrary) {
  for (const char* provider : {"openai", "anthropic", "gemini"}) {
    const auto format = MakeWireFormat(provider);
    for (const char* line :
         {"{}", "[]", "{", "", "7", R"({"custom_id":7})", R"({"key":7})",
          R"({"custom_id":"a-0","response":null,"error":null})",
          R"({"custom_id":"a-0","response":{"status_code":200,"body":null}})",
          R"({"custom_id":"a-0","response":{"status_code":2e9,"body":{}}})",
          R"({"custom_id":"a-0","response":{"status_code":200,
              "body":{"output":[{"type":"message"}]}}})",
          R"({"custom_id":"a-0","result":{"type":7}})",
          R"({"custom_id":"a-0","result":{"type":"succeeded","message":{}}})",
          R"({"key":"a-0","response":{"candidates":[]}})",
          R"({"key":"a-0","response":7})", R"({"key":"a-0"})"}) {
      const auto read = ReadBatchResult(*format, line);
      EXPECT_THAT(read.ok() ? read->reply.error : read.error().message,
                  ::testing::AllOf(::testing::Not(HasSubstr("json.exception")),
                                   ::testing::Not(::testing::IsEmpty())))
          << provider << " " << line;
    }
  }
}

TEST(BatchFormat, AFailureInPlaceOfTheAnswerIsNoAnswer) {
  const auto read = ReadBatchResult(
      *MakeGeminiFormat(),
      R"({"key":"a-0","response":{"candidates":[{"error":{"code":503,
          "message":"no instance"}}]}})");
  ASSERT_TRUE(read.ok());
  EXPECT_FALSE(read->reply.came());
  EXPECT_EQ(read->reply.error, "503: no instance");
}

}  // namespace
}  // namespace terra::advisor

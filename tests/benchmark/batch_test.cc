// From a dataset to a provider's batch, and from its results to figures. The
// result files are made by hand from the providers' documented forms.
#include "benchmark/batch.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmark/llm_method.h"
#include "benchmark/loaded_run.h"
#include "benchmark/metrics.h"
#include "tests/benchmark/metrics_of_all.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using nlohmann::json;
using terra::testing::ErrorMessage;
using terra::testing::ReadBytes;
using terra::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<json> Lines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(json::parse(line));
  }
  return lines;
}

// The answer that a real model gave to a case.
std::string RealAnswer(const std::string& case_id) {
  return ReadBytes(TERRA_TEST_DATA "/llm-answers/answers/native/" + case_id +
                   ".txt");
}

// A line of results that says `text`.
json Succeeded(const std::string& provider, const std::string& id,
               const std::string& text) {
  if (provider == "openai") {
    const json content = {{"type", "output_text"}, {"text", text}};
    const json body = {
        {"id", "resp_1"},
        {"status", "completed"},
        {"model", "gpt-5.5-2026"},
        {"output",
         {{{"type", "message"}, {"content", json::array({content})}}}},
        {"usage", {{"input_tokens", 2000}, {"output_tokens", 100}}}};
    return {{"custom_id", id},
            {"response", {{"status_code", 200}, {"body", body}}},
            {"error", nullptr}};
  }
  if (provider == "anthropic") {
    const json message = {
        {"id", "msg_1"},
        {"model", "claude-opus-4-8"},
        {"content", {{{"type", "text"}, {"text", text}}}},
        {"stop_reason", "end_turn"},
        {"usage", {{"input_tokens", 2000}, {"output_tokens", 100}}}};
    return {{"custom_id", id},
            {"result", {{"type", "succeeded"}, {"message", message}}}};
  }
  const json candidate = {{"content", {{"parts", {{{"text", text}}}}}},
                          {"finishReason", "STOP"}};
  const json usage = {{"promptTokenCount", 2000},
                      {"candidatesTokenCount", 100}};
  return {{"key", id},
          {"response",
           {{"candidates", json::array({candidate})},
            {"usageMetadata", usage},
            {"modelVersion", "gemini-3.1-pro-preview"}}}};
}

json Errored(const std::string& provider, const std::string& id) {
  if (provider == "openai") {
    return {{"custom_id", id},
            {"response",
             {{"status_code", 500},
              {"body", {{"error", {{"message", "try later"}}}}}}},
            {"error", nullptr}};
  }
  if (provider == "anthropic") {
    return {{"custom_id", id},
            {"result",
             {{"type", "errored"},
              {"error",
               {{"type", "error"}, {"error", {{"message", "try later"}}}}}}}};
  }
  return {{"key", id}, {"error", {{"code", 13}, {"message", "try later"}}}};
}

json Expired(const std::string& provider, const std::string& id) {
  if (provider == "openai") {
    return {
        {"custom_id", id},
        {"response", nullptr},
        {"error", {{"code", "batch_expired"}, {"message", "batch expired"}}}};
  }
  if (provider == "anthropic") {
    return {{"custom_id", id}, {"result", {{"type", "expired"}}}};
  }
  return {{"key", id}, {"error", {{"code", 4}, {"message", "batch expired"}}}};
}

class Batch : public ::testing::TestWithParam<std::string> {
 protected:
  // The ids of a batch's requests, as the provider finds them in the files.
  std::vector<std::string> Export(const std::string& provider,
                                  const std::string& out,
                                  const std::vector<std::string>& cases = {},
                                  const std::string& except = "") {
    advisor::LlmBackendOptions llm;
    llm.service.backend = provider;
    RunOptions options;
    options.cases.ids = cases;
    const auto written =
        ExportBatch(dataset_, options, llm, {folder_.Path(out), except, false});
    EXPECT_TRUE(written.ok()) << ErrorMessage(written);
    std::vector<std::string> ids;
    for (const std::string& file : written->files) {
      const std::string text = ReadBytes(file);
      if (provider == "anthropic") {
        const json batch = json::parse(text);
        for (const json& item : batch.at("requests")) {
          ids.push_back(item.at("custom_id").get<std::string>());
        }
        continue;
      }
      for (const json& line : Lines(text)) {
        ids.push_back(line.at(provider == "openai" ? "custom_id" : "key")
                          .get<std::string>());
      }
    }
    EXPECT_EQ(ids.size(), static_cast<std::size_t>(written->requests));
    return ids;
  }

  Result<ImportedBatch> Import(const std::string& batch,
                               const std::vector<json>& results) {
    std::string text;
    for (const json& line : results) text += line.dump() + "\n";
    advisor::PriceTable prices;
    EXPECT_TRUE(prices.Add("claude-opus-4-8=1:10").ok());
    return ImportBatch(folder_.Path(batch),
                       {folder_.Write(batch + "-results.jsonl", text)},
                       folder_.Path("calls.jsonl"), prices);
  }

  LoadedRun ReplayRun(const std::vector<std::string>& cases = {}) {
    advisor::LlmBackendOptions options;
    options.service.backend = "replay";
    options.service.recording = folder_.Path("calls.jsonl");
    auto made = MakeLlmMethod(options, {});
    EXPECT_TRUE(made.ok()) << ErrorMessage(made);
    RunOptions run;
    run.jobs = 1;
    run.cases.ids = cases;
    const Status done = RunMethods(
        dataset_, run,
        {{made->choice, folder_.Path("run"), made->settings_json}}, {});
    EXPECT_TRUE(done.ok()) << ErrorMessage(done);
    return LoadRuns({folder_.Path("run")}).value().front();
  }

  TempFolder folder_;
  const Dataset dataset_ = ReadDataset(TERRA_TEST_DATA "/llm-answers").value();
};

INSTANTIATE_TEST_SUITE_P(All, Batch,
                         ::testing::Values("openai", "anthropic", "gemini"),
                         [](const auto& tested) {
                           return tested.param;
                         });

TEST_P(Batch, ReplaysAsIfEachQuestionHadBeenAskedByItself) {
  const auto ids = Export(GetParam(), "batch");
  const auto open = Lines(ReadBytes(folder_.Path("batch/open.jsonl")));
  ASSERT_EQ(ids.size(), 32u);
  ASSERT_EQ(open.size(), 32u);
  std::vector<json> results;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    results.push_back(
        Succeeded(GetParam(), ids[i], RealAnswer(open[i].at("case_id"))));
  }
  std::reverse(results.begin(), results.end());
  const auto imported = Import("batch", results);
  ASSERT_TRUE(imported.ok()) << ErrorMessage(imported);
  EXPECT_EQ(imported->imported, 32);

  const LoadedRun run = ReplayRun();
  EXPECT_TRUE(run.complete());
  const Metrics m = MetricsOfAll(run);
  EXPECT_EQ(m.lower, 27);
  EXPECT_NEAR(100 * m.mogr->value, 83.74, 0.005);
  EXPECT_EQ(m.tokens_in, 64'000);
  EXPECT_FALSE(m.llm_median) << "a batch has no time of a call";
  EXPECT_FALSE(m.fps);
  EXPECT_TRUE(m.prep_median);
}

TEST_P(Batch, WhatFailedExpiredOrIsMissingHasNoAnswerAndIsAskedAgain) {
  const std::vector<std::string> cases = {"easy_0000", "easy_0001", "easy_0002",
                                          "easy_0003"};
  const auto ids = Export(GetParam(), "batch", cases);
  ASSERT_EQ(ids.size(), 4u);
  const auto imported =
      Import("batch", {Succeeded(GetParam(), "of-another-batch-0", "Yes"),
                       Errored(GetParam(), ids[2]), Expired(GetParam(), ids[1]),
                       Succeeded(GetParam(), ids[0], RealAnswer("easy_0000")),
                       Succeeded(GetParam(), ids[0], "Yes")});
  ASSERT_TRUE(imported.ok()) << ErrorMessage(imported);
  EXPECT_EQ(imported->imported, 1);
  EXPECT_EQ(imported->failed, 2);
  EXPECT_EQ(imported->missing, 1);
  EXPECT_EQ(imported->foreign, 1);
  EXPECT_EQ(imported->doubled, 1);
  EXPECT_THAT(imported->failures,
              ElementsAre(HasSubstr("easy_0001: "), HasSubstr("easy_0002: ")));
  EXPECT_THAT(imported->failures[0], HasSubstr("expired"));
  EXPECT_THAT(imported->failures[1], HasSubstr("try later"));

  const LoadedRun run = ReplayRun(cases);
  EXPECT_FALSE(run.complete());
  EXPECT_EQ(MetricsOfAll(run).no_answer, 3);

  auto again = Export(GetParam(), "again", cases, folder_.Path("calls.jsonl"));
  EXPECT_THAT(again, ElementsAre(ids[1], ids[2], ids[3]));
}

TEST_F(Batch, ImportingTwiceChangesNothing) {
  const auto ids = Export("anthropic", "batch", {"easy_0000"});
  const std::vector<json> results = {
      Succeeded("anthropic", ids.at(0), RealAnswer("easy_0000"))};
  EXPECT_EQ(Import("batch", results)->imported, 1);
  const std::string before = ReadBytes(folder_.Path("calls.jsonl"));
  const auto second = Import("batch", results);
  EXPECT_EQ(second->imported, 0);
  EXPECT_EQ(second->known, 1);
  EXPECT_EQ(ReadBytes(folder_.Path("calls.jsonl")), before);
  EXPECT_NEAR(Lines(before).at(0).at("spend_usd").get<double>(),
              (2000 * 1 + 100 * 10) / 1e6, 1e-12);
}

TEST_F(Batch, ADamagedResultFileIsRefusedWithItsLine) {
  Export("openai", "batch", {"easy_0000"});
  const std::string file = folder_.Write("results.jsonl", "\n{\"custom_id\":");
  const auto imported = ImportBatch(folder_.Path("batch"), {file},
                                    folder_.Path("calls.jsonl"), {});
  ASSERT_FALSE(imported.ok());
  EXPECT_THAT(imported.error().message, HasSubstr("results.jsonl:2: "));
  EXPECT_EQ(ReadBytes(folder_.Path("calls.jsonl")), "");
}

TEST_F(Batch, AFolderTakesOneBatchOnly) {
  Export("openai", "batch", {"easy_0000"});
  advisor::LlmBackendOptions llm;
  llm.service.backend = "openai";
  EXPECT_FALSE(
      ExportBatch(dataset_, {}, llm, {folder_.Path("batch"), "", false}).ok());
  llm.service.backend = "chat";
  EXPECT_FALSE(
      ExportBatch(dataset_, {}, llm, {folder_.Path("other"), "", false}).ok());
  EXPECT_FALSE(
      ImportBatch(folder_.Path("none"), {}, folder_.Path("r"), {}).ok());
}

}  // namespace
}  // namespace terra::benchmark

// From a recording to the metrics, on the recorded answers of a real model
// (tests/data/recordings). The figures to reach are those of the independent
// implementation in tests/data/llm-answers/README.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/llm_method.h"
#include "benchmark/loaded_run.h"
#include "benchmark/paper_tables.h"
#include "benchmark/results_reader.h"
#include "benchmark/run.h"
#include "benchmark/run_labels.h"
#include "tests/benchmark/metrics_of_all.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;

class Replay : public ::testing::Test {
 protected:
  LoadedRun Run(const std::string& out, bool polish) {
    advisor::LlmBackendOptions options;
    options.service.backend = "replay";
    options.service.recording = TERRA_TEST_DATA "/recordings/advisor-32.jsonl";
    auto made = MakeLlmMethod(options, {.polish = polish});
    EXPECT_TRUE(made.ok()) << ErrorMessage(made);
    RunOptions run;
    run.jobs = 1;
    const Status done = RunMethods(
        ReadDataset(TERRA_TEST_DATA "/llm-answers").value(), run,
        {{made->choice, folder_.Path(out), made->settings_json}}, {});
    EXPECT_TRUE(done.ok()) << ErrorMessage(done);
    return LoadRuns({folder_.Path(out)}).value().front();
  }

  std::vector<CaseResult> WithoutOwnTimes(const std::string& out) {
    std::vector<CaseResult> results;
    EXPECT_TRUE(
        ReadResults(folder_.Path(out + "/results.csv"), [&](CaseResult r) {
          r.t_prep = r.t_det = 0;
          results.push_back(std::move(r));
        }).ok());
    return results;
  }

  TempFolder folder_;
};

TEST_F(Replay, RawAnswersScoreAsTheIndependentImplementationSays) {
  const LoadedRun run = Run("raw", false);
  EXPECT_TRUE(run.complete());  // Else the prompt changed: make.sh there.
  const Metrics m = MetricsOfAll(run);
  EXPECT_EQ(m.paths, 32);
  EXPECT_EQ(m.suggested, 28);
  EXPECT_EQ(m.lower, 27);
  EXPECT_EQ(m.invalid, 0);
  EXPECT_EQ(m.gaps, 28);
  EXPECT_NEAR(100 * m.fir->value, 84.38, 0.005);
  EXPECT_NEAR(100 * m.asr->value, 96.43, 0.005);
  EXPECT_NEAR(100 * m.acr->value, 11.89, 0.005);
  EXPECT_NEAR(100 * m.mogr->value, 83.74, 0.005);
  EXPECT_EQ(m.ndr->value, 1);
}

TEST_F(Replay, PolishedAnswersScoreAsTheIndependentImplementationSays) {
  const LoadedRun run = Run("polished", true);
  const Metrics m = MetricsOfAll(run);
  EXPECT_NEAR(100 * m.fir->value, 87.50, 0.005);
  EXPECT_NEAR(100 * m.asr->value, 100, 0.005);
  EXPECT_NEAR(100 * m.acr->value, 13.06, 0.005);
  EXPECT_NEAR(100 * m.mogr->value, 99.15, 0.005);
}

TEST_F(Replay, ASecondReplayGivesTheSameRows) {
  Run("first", false);
  Run("second", false);
  EXPECT_EQ(WithoutOwnTimes("first"), WithoutOwnTimes("second"));
}

TEST_F(Replay, TheRowNamesTheModelThatTheReplyNamed) {
  const LoadedRun run = Run("raw", false);
  EXPECT_EQ(RowTitle(run),
            "LLM-Advisor: unnamed-llm-native (asked for unnamed-llm-native of "
            "exchange by replay; recorded 2026-11-26)");
  EXPECT_EQ(RowTitle(Run("polished", true)),
            "LLM-Advisor: unnamed-llm-native (asked for unnamed-llm-native of "
            "exchange by replay; polished; recorded 2026-11-26)");
  EXPECT_TRUE(IsPlain(run));
  EXPECT_EQ(SettingOf(run, "noise"), "0");
  // It stands for no provider's row.
  EXPECT_THAT(ToMarkdown(ComparisonTable({run}, "easy")),
              HasSubstr("LLM-Advisor (gpt-5.5) | not measured"));
}

TEST_F(Replay, QuestionsThatWereNotRecordedHaveNoAnswer) {
  advisor::LlmBackendOptions options;
  options.service.backend = "replay";
  options.service.recording = TERRA_TEST_DATA "/recordings/advisor-32.jsonl";
  options.method.prompt.rea = false;
  auto made = MakeLlmMethod(options, {});
  ASSERT_TRUE(made.ok());
  RunOptions run;
  run.jobs = 1;
  run.cases.ids = {"easy_0000"};
  ASSERT_TRUE(
      RunMethods(ReadDataset(TERRA_TEST_DATA "/llm-answers").value(), run,
                 {{made->choice, folder_.Path("x"), made->settings_json}}, {})
          .ok());
  const LoadedRun loaded = LoadRuns({folder_.Path("x")}).value().front();
  EXPECT_FALSE(loaded.complete());
  EXPECT_THAT(RowTitle(loaded), HasSubstr("[incomplete]"));
  EXPECT_EQ(MetricsOfAll(loaded).no_answer, 1);
}

}  // namespace
}  // namespace terra::benchmark

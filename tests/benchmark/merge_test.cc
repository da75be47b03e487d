#include "benchmark/merge.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/case_result.h"
#include "benchmark/generate_dataset.h"
#include "benchmark/loaded_run.h"
#include "benchmark/results_reader.h"
#include "benchmark/run.h"
#include "benchmark/run_description.h"
#include "terrain/files/whole_file.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;
using ::testing::Not;

class MergeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    GenerateOptions options;
    options.subsets = {Subset::kEasy, Subset::kHard};
    options.count = 4;
    options.seed = 91;
    ASSERT_TRUE(GenerateDataset(options, folder_.Path("data")).ok());
  }

  void Run(const std::string& out, const RunOptions& options,
           bool several_candidates = false) {
    const Dataset dataset = ReadDataset(folder_.Path("data")).value();
    MethodChoice choice =
        FindDeterministicMethod("advisor", "search", false).value();
    choice.info.several_candidates = several_candidates;
    const Status done =
        RunMethods(dataset, options, {{choice, folder_.Path(out), "{}"}}, {});
    ASSERT_TRUE(done.ok()) << ErrorMessage(done);
  }

  std::vector<CaseResult> ResultsOf(const std::string& name) {
    std::vector<CaseResult> results;
    const Status read =
        ReadResults(folder_.Path(name + "/results.csv"), [&](CaseResult r) {
          r.t_prep = r.t_det = 0;
          results.push_back(std::move(r));
        });
    EXPECT_TRUE(read.ok()) << ErrorMessage(read);
    return results;
  }

  TempFolder folder_;
};

TEST_F(MergeTest, ShardsMakeTheRunInOnePiece) {
  RunOptions options;
  options.repeats = 2;
  options.jobs = 1;
  Run("whole", options);
  std::vector<std::string> shards;
  for (int i = 1; i <= 3; ++i) {
    options.shard = {i, 3};
    const std::string name = "shard" + std::to_string(i);
    Run(name, options);
    shards.push_back(folder_.Path(name));
  }
  const auto counts = MergeRuns(shards, folder_.Path("merged"));
  ASSERT_TRUE(counts.ok()) << ErrorMessage(counts);
  EXPECT_EQ(*counts, 16);
  EXPECT_EQ(ResultsOf("merged"), ResultsOf("whole"));
  const auto runs = LoadRuns({folder_.Path("merged"), folder_.Path("whole")});
  ASSERT_TRUE(runs.ok()) << ErrorMessage(runs);
  EXPECT_TRUE(runs->at(0).complete());
  // Side by side the shards did not take one case at a time.
  EXPECT_EQ(runs->at(0).description.jobs, 3);
  EXPECT_FALSE(FindMismatch(runs->at(0), runs->at(1)).value());
}

TEST_F(MergeTest, ColumnsOfCandidatesAreKept) {
  RunOptions options;
  options.cases.ids = {"easy_0000", "hard_0000"};
  for (const int i : {1, 2}) {
    options.shard = {i, 2};
    Run("shard" + std::to_string(i), options, true);
  }
  const auto merged = MergeRuns(
      {folder_.Path("shard1"), folder_.Path("shard2")}, folder_.Path("merged"));
  ASSERT_TRUE(merged.ok()) << ErrorMessage(merged);
  const std::vector<CaseResult> results = ResultsOf("merged");
  ASSERT_EQ(results.size(), 2U);
  for (const CaseResult& r : results) EXPECT_EQ(r.candidates, 1);
}

TEST_F(MergeTest, ShardsThatAreMissingOrNotFinishedAreNamed) {
  RunOptions options;
  for (const int i : {1, 3, 5}) {
    options.shard = {i, 5};
    Run("shard" + std::to_string(i), options);
  }
  // Shard 1 was killed, shard 3 lost a row, 2 and 4 are not there.
  auto killed = ReadRunDescription(folder_.Path("shard1/run.json")).value();
  killed.finished.clear();
  ASSERT_TRUE(
      WriteRunDescription(killed, folder_.Path("shard1/run.json")).ok());
  const std::string results = folder_.Path("shard3/results.csv");
  std::string text = ReadWholeFile(results, 1 << 20).value();
  text.resize(text.rfind('\n', text.size() - 2) + 1);
  folder_.Write("shard3/results.csv", text);
  const std::string error = ErrorMessage(MergeRuns(
      {folder_.Path("shard5"), folder_.Path("shard3"), folder_.Path("shard1")},
      folder_.Path("merged")));
  EXPECT_THAT(error, HasSubstr("shard 1 of 5 in " + folder_.Path("shard1") +
                               " is not finished"));
  EXPECT_THAT(error, HasSubstr("shard 2 of 5 is missing"));
  EXPECT_THAT(error, HasSubstr("shard 3 of 5 in " + folder_.Path("shard3") +
                               " has 1 of 2 rows"));
  EXPECT_THAT(error, HasSubstr("shard 4 of 5 is missing"));
  EXPECT_THAT(error, Not(HasSubstr("shard 5 of 5")));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("merged")));
}

TEST_F(MergeTest, AShardThatCannotBeIsRefused) {
  RunOptions options;
  Run("a", options);
  const std::string path = folder_.Path("a/run.json");
  const RunDescription good = ReadRunDescription(path).value();
  for (const Shard wrong : {Shard{0, 1}, Shard{2, 1}, Shard{1, 0}}) {
    RunDescription bad = good;
    bad.shard = wrong;
    ASSERT_TRUE(WriteRunDescription(bad, path).ok());
    EXPECT_THAT(ErrorMessage(MergeRuns({folder_.Path("a")}, folder_.Path("m"))),
                HasSubstr("repeats or shards"));
  }
}

TEST_F(MergeTest, MoreShardsThanCasesAreMergedAsWell) {
  RunOptions options;
  options.cases.ids = {"easy_0001", "hard_0001"};
  Run("whole", options);
  std::vector<std::string> shards;
  for (const int i : {3, 1, 2}) {
    options.shard = {i, 3};
    const std::string name = "shard" + std::to_string(i);
    Run(name, options);
    shards.push_back(folder_.Path(name));
  }
  ASSERT_TRUE(MergeRuns(shards, folder_.Path("merged")).ok());
  EXPECT_EQ(ResultsOf("merged"), ResultsOf("whole"));
}

TEST_F(MergeTest, RefusesPartsOfDifferentRunsAndTheSamePartTwice) {
  RunOptions options;
  Run("a", options);
  options.lattice.stride = 20;
  Run("b", options);
  EXPECT_THAT(ErrorMessage(MergeRuns({folder_.Path("a"), folder_.Path("b")},
                                     folder_.Path("merged"))),
              HasSubstr("different runs"));
  EXPECT_THAT(ErrorMessage(MergeRuns({folder_.Path("a"), folder_.Path("a")},
                                     folder_.Path("merged"))),
              HasSubstr("are both shard 1 of 1"));
}

TEST_F(MergeTest, RunsThatDifferCannotStandInOneTable) {
  RunOptions options;
  Run("a", options);
  options.lattice.stride = 20;
  Run("b", options);
  options = {};
  options.cases.ids = {"easy_0001", "hard_0001"};
  Run("c", options);
  auto runs =
      LoadRuns({folder_.Path("a"), folder_.Path("b"), folder_.Path("c")});
  ASSERT_TRUE(runs.ok());
  const auto b = FindMismatch(runs->at(0), runs->at(1)).value();
  ASSERT_TRUE(b);
  EXPECT_EQ(b->what, Shared::kStride);
  EXPECT_THAT(b->text, HasSubstr("stride"));
  EXPECT_EQ(FindMismatch(runs->at(0), runs->at(2)).value()->what,
            Shared::kCaseList);
  EXPECT_FALSE(
      FindMismatch(runs->at(0), runs->at(2), {Shared::kCaseList}).value());
  // Where lists may differ, nothing else may.
  EXPECT_EQ(
      FindMismatch(runs->at(1), runs->at(2), {Shared::kCaseList}).value()->what,
      Shared::kStride);
  std::vector<LoadedRun> common = {runs->at(0), runs->at(2)};
  ASSERT_TRUE(KeepCommonCases(common).ok());
  for (const LoadedRun& run : common) {
    EXPECT_EQ(run.num_rows, 2);
    EXPECT_EQ(MetricsOf(run, "easy").paths, 1);
  }
}

}  // namespace
}  // namespace terra::benchmark

#include "benchmark/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/case_result.h"
#include "benchmark/generate_dataset.h"
#include "benchmark/loaded_run.h"
#include "benchmark/run.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;

class MergeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    GenerateOptions options;
    options.subsets = {Subset::kEasy, Subset::kHard};
    options.count = 4;
    options.seed = 91;
    ASSERT_TRUE(GenerateDataset(options, folder_.Path("data")).ok());
  }

  void Run(const std::string& out, const RunOptions& options) {
    const Dataset dataset = ReadDataset(folder_.Path("data")).value();
    const Status done = RunMethods(
        dataset, options,
        {{FindDeterministicMethod("advisor", "search", false).value(),
          folder_.Path(out), "{}"}},
        {});
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
  EXPECT_EQ(counts->rows, 16);
  EXPECT_EQ(counts->missing, 0);
  EXPECT_EQ(ResultsOf("merged"), ResultsOf("whole"));
  const auto runs = LoadRuns({folder_.Path("merged"), folder_.Path("whole")});
  ASSERT_TRUE(runs.ok()) << ErrorMessage(runs);
  EXPECT_TRUE(runs->at(0).complete());
  EXPECT_EQ(WhyNotComparable(runs->at(0), runs->at(1)), "");
}

TEST_F(MergeTest, AMissingShardIsCounted) {
  RunOptions options;
  options.shard = {2, 3};
  Run("shard2", options);
  const auto counts =
      MergeRuns({folder_.Path("shard2")}, folder_.Path("merged"));
  ASSERT_TRUE(counts.ok()) << ErrorMessage(counts);
  EXPECT_EQ(counts->rows, 3);
  EXPECT_EQ(counts->missing, 5);
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
              HasSubstr("in two of the parts"));
}

TEST_F(MergeTest, RunsThatDifferCannotStandInOneTable) {
  RunOptions options;
  Run("a", options);
  options.lattice.stride = 20;
  Run("b", options);
  options = {};
  options.cases = {"easy_0001", "hard_0001"};
  Run("c", options);
  auto runs =
      LoadRuns({folder_.Path("a"), folder_.Path("b"), folder_.Path("c")});
  ASSERT_TRUE(runs.ok());
  EXPECT_THAT(WhyNotComparable(runs->at(0), runs->at(1)), HasSubstr("stride"));
  EXPECT_THAT(WhyNotComparable(runs->at(0), runs->at(2)),
              HasSubstr("case list"));
  std::vector<LoadedRun> common = {runs->at(0), runs->at(2)};
  KeepCommonCases(common);
  EXPECT_EQ(common[0].scores.size(), 2U);
  EXPECT_EQ(common[1].scores.size(), 2U);
}

}  // namespace
}  // namespace terra::benchmark

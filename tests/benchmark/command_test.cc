// `terra bench` as users run it, killed at any moment.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/case_result.h"
#include "benchmark/results_reader.h"
#include "terrain/files/whole_file.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

using terra::testing::ChildProcess;
using terra::testing::ProgramPath;
using terra::testing::RunResult;
using terra::testing::RunToEnd;
using terra::testing::TempFolder;
using ::testing::HasSubstr;
using ::testing::Not;

class BenchCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const RunResult made =
        RunToEnd({terra_, "bench", "generate", "--subset", "hard", "--count",
                  "40", "--seed", "3", "--out", folder_.Path("data")});
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }

  std::vector<std::string> RunArguments(const std::string& out) const {
    return {terra_,
            "bench",
            "run",
            "--dataset",
            folder_.Path("data"),
            "--method",
            "advisor",
            "--backend",
            "shortcut",
            "--out",
            folder_.Path(out)};
  }

  std::vector<CaseResult> Results(const std::string& out) const {
    std::vector<CaseResult> results;
    EXPECT_TRUE(
        ReadResults(folder_.Path(out + "/results.csv"), [&](CaseResult r) {
          r.t_prep = r.t_det = 0;
          results.push_back(std::move(r));
        }).ok());
    return results;
  }

  // Whole lines in the results; 0 when there are none yet.
  std::ptrdiff_t Lines(const std::string& out) const {
    std::ifstream file(folder_.Path(out + "/results.csv"));
    return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
  }

  const std::string terra_ = ProgramPath("terra");
  TempFolder folder_;
};

TEST_F(BenchCommand, KilledAgainAndAgainARunLosesAndRepeatsNoCase) {
  ASSERT_EQ(RunToEnd(RunArguments("whole")).exit_code, 0);
  std::ptrdiff_t lines = 0;
  for (int kills = 0; kills < 4; ++kills) {
    ChildProcess run(RunArguments("killed"));
    while (run.running() && Lines("killed") < lines + 5) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    run.Kill();
    lines = Lines("killed");
  }
  const RunResult last = RunToEnd(RunArguments("killed"));
  ASSERT_EQ(last.exit_code, 0) << last.output;
  EXPECT_EQ(Results("killed"), Results("whole"));
}

TEST_F(BenchCommand, AListOfNoCasesOrOfOneTwiceIsRefused) {
  const std::string twice = folder_.Write("twice", "hard_0001\nhard_0001\n");
  for (const auto& [cases, why] :
       {std::pair<std::string, std::string>{"0", "at least one case"},
        {"-1", "at least one case"},
        {twice, "names 'hard_0001' twice"},
        {folder_.Write("none", "\n"), "names no case"},
        {folder_.Write("unknown", "hard_0001\nx\n"), "has no case 'x'"}}) {
    std::vector<std::string> arguments = RunArguments("out");
    arguments.push_back("--cases=" + cases);
    const RunResult run = RunToEnd(arguments);
    EXPECT_EQ(run.exit_code, 1) << cases;
    EXPECT_THAT(run.output, HasSubstr(why));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("out")));
}

TEST_F(BenchCommand, TheTasksOfASlurmArrayMakeTheRunInOnePiece) {
  ASSERT_EQ(RunToEnd(RunArguments("whole")).exit_code, 0);
  std::vector<std::string> merge = {terra_, "bench", "merge", "--out",
                                    folder_.Path("merged")};
  for (const std::string task : {"1", "2", "3"}) {
    // What Slurm gives to each task of the array.
    const RunResult ran = RunToEnd(
        {"/usr/bin/env", "TERRA=" + terra_, "RUN_OUT=" + folder_.Path("merged"),
         "SLURM_ARRAY_TASK_ID=" + task, "SLURM_ARRAY_TASK_COUNT=3",
         TERRA_SCRIPTS "/bench-slurm", "--dataset", folder_.Path("data"),
         "--method", "advisor", "--backend", "shortcut"});
    ASSERT_EQ(ran.exit_code, 0) << ran.output;
    merge.push_back(folder_.Path("merged.shards/" + task));
  }
  const RunResult merged = RunToEnd(merge);
  ASSERT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_EQ(Results("merged"), Results("whole"));
}

TEST_F(BenchCommand, GnuParallelMakesTheRunInOnePiece) {
  if (RunToEnd({"/bin/sh", "-c", "command -v parallel"}).exit_code != 0) {
    GTEST_SKIP() << "needs GNU Parallel (apt-get install parallel)";
  }
  ASSERT_EQ(RunToEnd(RunArguments("whole")).exit_code, 0);
  const RunResult ran = RunToEnd(
      {"/usr/bin/env", "TERRA=" + terra_, "RUN_OUT=" + folder_.Path("merged"),
       "SHARDS=3", TERRA_SCRIPTS "/bench-parallel", "--dataset",
       folder_.Path("data"), "--method", "advisor", "--backend", "shortcut"});
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_EQ(Results("merged"), Results("whole"));
}

TEST_F(BenchCommand, AReportOpensWithoutAnyOtherFile) {
  ASSERT_EQ(RunToEnd(RunArguments("runs/shortcut")).exit_code, 0);
  const RunResult made = RunToEnd(
      {terra_, "bench", "report", "--runs", folder_.Path("runs"), "--dataset",
       folder_.Path("data"), "--out", folder_.Path("report")});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::string page =
      ReadWholeFile(folder_.Path("report/report.html"), 1 << 26).value();
  EXPECT_THAT(page, HasSubstr("not measured; OPENAI_API_KEY="));
  EXPECT_THAT(page, HasSubstr("other maps, prompt and joints"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("href=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  for (const char* name : {"comparison-hard", "oracle-gap", "ablation", "rugd",
                           "latency", "noise", "runs"}) {
    for (const char* extension : {".csv", ".md", ".tex"}) {
      EXPECT_TRUE(std::filesystem::exists(
          folder_.Path(std::string("report/tables/") + name + extension)));
    }
  }
}

TEST_F(BenchCommand, RowsThatCannotStandTogetherAreRefused) {
  ASSERT_EQ(RunToEnd(RunArguments("a")).exit_code, 0);
  std::vector<std::string> other = RunArguments("b");
  other.insert(other.end(), {"--stride", "20"});
  ASSERT_EQ(RunToEnd(other).exit_code, 0);
  const RunResult table =
      RunToEnd({terra_, "bench", "table", "comparison-hard", "--runs",
                folder_.Path("a"), folder_.Path("b")});
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_THAT(table.output, HasSubstr("differ in their stride"));
}

TEST_F(BenchCommand, WrongUsageIsExitCodeTwo) {
  EXPECT_EQ(RunToEnd({terra_, "bench"}).exit_code, 2);
  EXPECT_EQ(RunToEnd({terra_, "bench", "generate", "--out", "x"}).exit_code, 2);
  std::vector<std::string> run = RunArguments("x");
  run.insert(run.end(), {"--shard", "3/2"});
  EXPECT_EQ(RunToEnd(run).exit_code, 2);
}

}  // namespace
}  // namespace terra::benchmark

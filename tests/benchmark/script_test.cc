// scripts/bench from nothing to the report, on a few maps.
#include <chrono>
#include <filesystem>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "benchmark/case_result.h"
#include "benchmark/run_description.h"
#include "terrain/files/image.h"
#include "terrain/files/whole_file.h"
#include "tests/support/child_process.h"
#include "tests/support/mat_png.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using terra::testing::ChildProcess;
using terra::testing::ProgramPath;
using terra::testing::RunResult;
using terra::testing::TempFolder;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;

class BenchScript : public ::testing::Test {
 protected:
  // Grass below sky, as the official archive lays frames out.
  void WriteMask() {
    cv::Mat mask(550, 688, CV_8UC3, cv::Scalar(255, 0, 0));
    mask.rowRange(250, 550).setTo(cv::Scalar(0, 102, 0));
    fs::create_directories(folder_.Path("masks/creek"));
    ASSERT_TRUE(WritePng(terra::testing::ViewOf(mask),
                         folder_.Path("masks/creek/creek_00001.png"))
                    .ok());
  }

  RunResult Run(const std::vector<std::string>& options) const {
    std::vector<std::string> command = {"/usr/bin/env",
                                        "TERRA=" + ProgramPath("terra"),
                                        TERRA_SCRIPTS "/bench",
                                        "--count",
                                        "2",
                                        "--out",
                                        folder_.Path("out")};
    command.insert(command.end(), options.begin(), options.end());
    // Some thirty programs one after the other: a minute is too little where
    // all cores are taken.
    ChildProcess script(command);
    const auto code = script.WaitForExit(std::chrono::minutes(4));
    return {code.value_or(-1), script.output()};
  }

  std::map<std::string, RunDescription> Runs() const {
    std::map<std::string, RunDescription> runs;
    const fs::path folder = folder_.Path("out/runs");
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().filename() != "run.json") continue;
      auto run = ReadRunDescription(entry.path().string());
      EXPECT_TRUE(run.ok()) << entry.path();
      const fs::path name =
          entry.path().parent_path().lexically_relative(folder);
      if (run.ok()) runs.emplace(name.string(), *std::move(run));
    }
    return runs;
  }

  TempFolder folder_;
};

TEST_F(BenchScript, MakesEveryRunAndTheReportWithTheJobsThatWereAskedFor) {
  WriteMask();
  const RunResult made = Run({"--jobs", "3", "--rugd", folder_.Path("masks")});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const auto runs = Runs();
  for (const char* name : {"stride-10/search",
                           "stride-100/shortcut",
                           "coarse",
                           "oracle",
                           "refiners/app",
                           "refiners/band",
                           "refiners/campana-terrain",
                           "campana-last",
                           "collision-shortcut",
                           "straight-line",
                           "corridor",
                           "blind-detours",
                           "llm-astar-single",
                           "straight-line-gate",
                           "joints-cell",
                           "joints-visible",
                           "recording",
                           "latency/coarse",
                           "rugd/shortcut",
                           "rugd-coarse"}) {
    EXPECT_THAT(runs, Contains(Key(name)));
  }
  for (const auto& [name, run] : runs) {
    const bool alone = name.rfind("latency/", 0) == 0 || run.asks_model;
    EXPECT_EQ(run.jobs, alone ? 1 : 3) << name;
    EXPECT_FALSE(run.finished.empty()) << name;
  }
  const std::string page =
      ReadWholeFile(folder_.Path("out/report/report.html"), 1 << 26).value();
  for (const auto& [name, run] : runs) EXPECT_THAT(page, HasSubstr(run.title));
}

TEST_F(BenchScript, StartedAgainItKeepsWhatIsThere) {
  ASSERT_EQ(Run({"--core"}).exit_code, 0);
  const std::string results =
      folder_.Path("out/runs/stride-50/search/results.csv");
  const std::string before = ReadWholeFile(results, 1 << 20).value();
  fs::remove(folder_.Path("out/runs/coarse/results.csv"));
  const RunResult again = Run({"--core"});
  ASSERT_EQ(again.exit_code, 0) << again.output;
  // Times included: nothing was measured a second time.
  EXPECT_EQ(ReadWholeFile(results, 1 << 20).value(), before);
  EXPECT_TRUE(fs::exists(folder_.Path("out/runs/coarse/results.csv")));
  const RunResult other = Run({"--core", "--count", "3"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.output, HasSubstr("maps of another --count"));
}

TEST_F(BenchScript, WrongUsageIsExitCodeTwo) {
  EXPECT_EQ(Run({"--count", "0"}).exit_code, 2);
  EXPECT_EQ(Run({"--jobs"}).exit_code, 2);
  EXPECT_EQ(Run({"--unknown"}).exit_code, 2);
}

}  // namespace
}  // namespace terra::benchmark

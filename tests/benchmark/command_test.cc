// `terra bench` as users run it, killed at any moment.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/case_result.h"
#include "benchmark/named_tables.h"
#include "benchmark/results_reader.h"
#include "benchmark/run_fields.h"
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

TEST_F(BenchCommand, CommonCasesHideNoOtherDifference) {
  // The folder is called as a reason is.
  std::vector<std::string> coarse = RunArguments("case list/a");
  coarse.insert(coarse.end(), {"--cases", "30"});
  std::vector<std::string> fine = RunArguments("b");
  fine.insert(fine.end(), {"--stride", "20", "--cases", "20"});
  std::vector<std::string> few = RunArguments("c");
  few.insert(few.end(), {"--cases", "20"});
  for (const auto& run : {coarse, fine, few}) {
    ASSERT_EQ(RunToEnd(run).exit_code, 0);
  }
  const auto table = [&](const std::string& other, bool intersect) {
    std::vector<std::string> arguments = {terra_,
                                          "bench",
                                          "table",
                                          "comparison-hard",
                                          "--runs",
                                          folder_.Path("case list/a"),
                                          folder_.Path(other)};
    if (intersect) arguments.emplace_back("--intersect");
    return RunToEnd(arguments);
  };
  const RunResult refused = table("b", true);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("differ in their stride"));
  const RunResult lists = table("c", false);
  EXPECT_EQ(lists.exit_code, 1);
  EXPECT_THAT(lists.output,
              HasSubstr("differ in their case list; --intersect"));
  const RunResult common = table("c", true);
  EXPECT_EQ(common.exit_code, 0) << common.output;
  EXPECT_THAT(common.output, HasSubstr("Only the 20 cases that all runs have"));
}

TEST_F(BenchCommand, EachTableOfAReportIsOneCommand) {
  // As scripts/bench makes them: strides, joint rules, methods with and without
  // fallback, some cases one at a time, another dataset.
  const auto run = [&](const std::string& out,
                       std::vector<std::string> options) {
    options.insert(options.begin(), {terra_, "bench", "run", "--out",
                                     folder_.Path("runs/" + out)});
    const RunResult ran = RunToEnd(options);
    ASSERT_EQ(ran.exit_code, 0) << ran.output;
  };
  const std::string data = folder_.Path("data");
  for (const char* stride : {"20", "50"}) {
    run(std::string("stride-") + stride,
        {"--dataset", data, "--method", "advisor", "--backend",
         "search,shortcut", "--stride", stride});
  }
  for (const char* method : {"coarse", "corridor", "straight-line"}) {
    run(method, {"--dataset", data, "--method", method});
  }
  run("joints", {"--dataset", data, "--method", "coarse", "--joints", "cell"});
  run("corners",
      {"--dataset", data, "--method", "coarse", "--corner-cutting", "off"});
  run("alone",
      {"--dataset", data, "--method", "coarse", "--cases", "5", "--jobs", "1"});
  run("recording", {"--dataset", TERRA_TEST_DATA "/llm-answers", "--method",
                    "advisor", "--backend", "replay", "--recording",
                    TERRA_TEST_DATA "/recordings/advisor-32.jsonl"});
  folder_.Write("runs/.DS_Store", "Bud1");
  const RunResult made =
      RunToEnd({terra_, "bench", "report", "--runs", folder_.Path("runs"),
                "--out", folder_.Path("report")});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  ASSERT_EQ(NamedTables().size(), 13U);
  for (const NamedTable& table : NamedTables()) {
    SCOPED_TRACE(table.name);
    const std::string out = folder_.Path("table.csv");
    const RunResult printed =
        RunToEnd({terra_, "bench", "table", table.name, "--runs",
                  folder_.Path("runs"), "--format", "csv", "--out", out});
    EXPECT_EQ(printed.exit_code, 0) << printed.output;
    EXPECT_EQ(ReadWholeFile(out, 1 << 20).value(),
              ReadWholeFile(
                  folder_.Path("report/tables/" + table.name + ".csv"), 1 << 20)
                  .value());
  }
  // A run that was named must have a row.
  const RunResult refused =
      RunToEnd({terra_, "bench", "table", "comparison-hard", "--runs",
                folder_.Path("runs"), folder_.Path("runs/joints")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("runs/joints cannot stand in"));
}

// What each option of `bench run` comes to: a field of run.json that decides
// figures, or why it decides none. A new option must be entered here.
// The long name of the option that a line of --help begins with; empty where
// it is no such line: "  -h,--help   Print this ..." gives "--help".
std::string OptionIn(const std::string& line) {
  std::size_t at = line.find_first_not_of(' ');
  if (at == 0 || at == std::string::npos) return "";
  if (at + 2 < line.size() && line[at + 2] == ',') at += 3;
  if (line.compare(at, 2, "--") != 0) return "";
  return line.substr(
      at, line.find_first_not_of("-abcdefghijklmnopqrstuvwxyz", at) - at);
}

TEST_F(BenchCommand, EveryOptionOfARunIsAFieldOfRunJsonOrDecidesNoFigure) {
  const std::map<std::string, std::string> fields = {
      {"--dataset", "/configuration/dataset/digest"},
      {"--method", "/configuration/method"},
      {"--backend", "/configuration/backend"},
      {"--gate", "/configuration/fallback"},
      {"--polish", "/configuration/settings/polish"},
      {"--cases", "/configuration/case_list_digest"},
      {"--repeats", "/configuration/repeats"},
      {"--stride", "/configuration/stride"},
      {"--joints", "/configuration/joints"},
      {"--corner-cutting", "/configuration/cost_model/corner_cutting"},
      {"--clearance", "/configuration/cost_model/clearance_cells"},
      {"--overlay", "/configuration/settings/overlay"},
      {"--route-text", "/configuration/settings/route_text"},
      {"--rea", "/configuration/settings/rea"},
      {"--picture", "/configuration/settings/axes"},
      {"--regions", "/configuration/settings/regions"},
      {"--stretches", "/configuration/settings/stretches"},
      {"--candidates", "/configuration/settings/candidates"},
      {"--references", "/configuration/settings/reference_pool"},
      {"--noise", "/configuration/settings/noise"},
      {"--seed", "/configuration/settings/seed"},
      {"--rounds", "/configuration/settings/rounds"},
      {"--model", "/configuration/settings/model"},
      {"--max-output-tokens",
       "/configuration/settings/model_settings/max_output_tokens"},
      {"--effort", "/configuration/settings/model_settings/effort"},
      {"--image-detail", "/configuration/settings/model_settings/image_detail"},
      {"--base-url", "/configuration/settings/endpoint_class"},
      {"--real-model", "/configuration/simulated"},
      {"--deadline", "/configuration/settings/rounds_deadline_s"}};
  const std::set<std::string> others = {
      // Which part, where to, how fast.
      "--help", "--shard", "--out", "--jobs", "--record", "--images", "--price",
      // How a call comes through. Without an answer a row is incomplete.
      "--anthropic-version", "--anthropic-bearer", "--try-timeout", "--retries",
      "--max-retry-wait", "--calls-per-minute", "--spend-per-hour",
      "--breaker-failures", "--breaker-wait", "--breaker-max-wait",
      // Where answers come from; who gave them is in run.json.
      "--exchange", "--recording",
      // How maps are read: the dataset's digest holds it.
      "--unknown"};
  const RunResult help = RunToEnd({terra_, "bench", "run", "--help"});
  std::size_t met = 0;
  std::istringstream lines(help.output);
  for (std::string line; std::getline(lines, line);) {
    const std::string name = OptionIn(line);
    if (name.empty()) continue;
    ++met;
    const auto field = fields.find(name);
    if (field == fields.end()) {
      EXPECT_TRUE(others.contains(name)) << name;
      continue;
    }
    const RunField* declared = FindField(field->second);
    ASSERT_NE(declared, nullptr) << name;
    EXPECT_NE(declared->role, FieldRole::kOrigin) << name;
  }
  EXPECT_EQ(met, fields.size() + others.size());
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

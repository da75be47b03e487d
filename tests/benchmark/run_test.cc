#include "benchmark/run.h"

#include <atomic>
#include <filesystem>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/generate_dataset.h"
#include "benchmark/loaded_run.h"
#include "benchmark/results_reader.h"
#include "benchmark/run_description.h"
#include "terrain/digest.h"
#include "terrain/files/whole_file.h"
#include "tests/support/ascii_map.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"
#include "verifier/verify.h"

namespace terra::benchmark {
namespace {

using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using verifier::Code;

// A method that answers what a test tells it to, and counts its calls.
class Scripted : public Method {
 public:
  Scripted(std::function<Attempt(const MethodInput&)> script,
           std::atomic<int>& calls)
      : script_(std::move(script)), calls_(calls) {}
  Attempt Try(const MethodInput& input) override {
    ++calls_;
    return script_(input);
  }

 private:
  std::function<Attempt(const MethodInput&)> script_;
  std::atomic<int>& calls_;
};

Attempt Propose(std::vector<Route> candidates) {
  Attempt attempt;
  attempt.kind = AttemptKind::kPropose;
  attempt.candidates = std::move(candidates);
  return attempt;
}

class RunTest : public ::testing::Test {
 protected:
  void SetUp() override {
    GenerateOptions options;
    options.subsets = {Subset::kEasy, Subset::kHard};
    options.count = 4;
    options.seed = 90;
    options.name = "small";
    ASSERT_TRUE(GenerateDataset(options, folder_.Path("data")).ok());
    dataset_ = ReadDataset(folder_.Path("data")).value();
  }

  MethodRun Run(const std::string& name,
                std::function<Attempt(const MethodInput&)> script,
                CountingRule rule = {}) {
    MethodInfo info;
    info.method = name;
    info.title = name;
    info.rule = rule;
    return {{info,
             [this, script]() -> Result<std::unique_ptr<Method>> {
               return std::unique_ptr<Method>(
                   std::make_unique<Scripted>(script, calls_));
             }},
            folder_.Path(name),
            "{}"};
  }

  MethodRun Named(const std::string& method, const std::string& backend,
                  const std::string& out) {
    return {FindDeterministicMethod(method, backend, false).value(),
            folder_.Path(out), "{}"};
  }

  std::vector<CaseResult> ResultsOf(const std::string& name) {
    std::vector<CaseResult> results;
    const Status read =
        ReadResults(folder_.Path(name + "/results.csv"), [&](CaseResult r) {
          results.push_back(std::move(r));
        });
    EXPECT_TRUE(read.ok()) << ErrorMessage(read);
    return results;
  }

  std::vector<std::string> IdsOf(const std::string& name) {
    std::vector<std::string> ids;
    for (const CaseResult& r : ResultsOf(name)) ids.push_back(r.case_id);
    return ids;
  }

  TempFolder folder_;
  Dataset dataset_{{"", "", "", "", "", terra::testing::AsciiLegend()}, {}};
  std::atomic<int> calls_{0};
};

TEST_F(RunTest, SearchReachesTheOracleOnEveryCase) {
  const Status done =
      RunMethods(dataset_, {}, {Named("advisor", "search", "search")}, {});
  ASSERT_TRUE(done.ok()) << ErrorMessage(done);
  const std::vector<CaseResult> results = ResultsOf("search");
  ASSERT_EQ(results.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    const DatasetCase& c = dataset_.cases[i];
    const CaseResult& r = results[i];
    const TerrainMap map = ReadCaseMap(dataset_, c).value();
    EXPECT_EQ(r.case_id, c.case_id);
    EXPECT_EQ(r.group, c.group);
    EXPECT_EQ(r.map_id, MapId(map));
    EXPECT_NEAR(r.final_cost, r.oracle_cost, 1e-9);
    const auto check =
        verifier::CheckRoute(map, r.final_route, c.start, c.goal);
    EXPECT_TRUE(check.feasible());
    EXPECT_EQ(check.cost, r.final_cost);
    EXPECT_EQ(r.code, r.candidate_cost < r.baseline_cost - 1e-6
                          ? Code::kAccepted
                          : Code::kNotCheaper);
  }
}

TEST_F(RunTest, WithFallbackABadRouteLeavesTheBaseline) {
  const auto run = Run("bad", [](const MethodInput& input) {
    return Propose({{input.dataset_case.start, {-5, 3}}});
  });
  ASSERT_TRUE(RunMethods(dataset_, {}, {run}, {}).ok());
  for (const CaseResult& r : ResultsOf("bad")) {
    EXPECT_EQ(r.code, Code::kGoalMismatch);
    EXPECT_EQ(r.candidate_cost, kImpassable);
    EXPECT_EQ(r.final_cost, r.baseline_cost);
  }
}

TEST_F(RunTest, WithoutFallbackTheRouteStandsAsItWasReturned) {
  const auto run = Run("bad",
                       [](const MethodInput& input) {
                         return Propose({{input.dataset_case.start, {-5, 3}}});
                       },
                       {.fallback = false, .every_case_attempts = true});
  ASSERT_TRUE(RunMethods(dataset_, {}, {run}, {}).ok());
  for (const CaseResult& r : ResultsOf("bad")) {
    EXPECT_EQ(r.final_cost, kImpassable);
    EXPECT_EQ(r.final_route.back(), (Cell{-5, 3}));
  }
}

TEST_F(RunTest, OfSeveralCandidatesTheCheapestAcceptedOneCounts) {
  const auto search = FindDeterministicMethod("advisor", "search", false);
  MethodRun run = Run("several", [&](const MethodInput& input) {
    const Route best = (*search->make())->Try(input).candidates.front();
    return Propose({{{0, 0}}, input.baseline.waypoints, best});
  });
  run.choice.info.several_candidates = true;
  ASSERT_TRUE(RunMethods(dataset_, {}, {run}, {}).ok());
  for (const CaseResult& r : ResultsOf("several")) {
    const bool gap = r.oracle_cost < r.baseline_cost - 1e-6;
    if (gap) {
      EXPECT_EQ(r.code, Code::kAccepted);
      EXPECT_NEAR(r.final_cost, r.oracle_cost, 1e-9);
    } else {
      EXPECT_EQ(r.code, Code::kTooFewWaypoints);  // None accepted: the first.
    }
    EXPECT_EQ(r.candidates, 3);
    EXPECT_EQ(r.candidates_lower, gap ? 1 : 0);
    EXPECT_EQ(r.candidates_invalid, 1);
  }
}

TEST_F(RunTest, CandidatesHaveColumnsOnlyWhereAnAnswerMayHaveSeveral) {
  const auto nothing = [](const MethodInput&) {
    return Propose({{}});
  };
  MethodRun several = Run("several", nothing);
  several.choice.info.several_candidates = true;
  ASSERT_TRUE(
      RunMethods(dataset_, {}, {several, Run("one", nothing)}, {}).ok());
  const auto header = [&](const std::string& name) {
    const std::string text =
        ReadWholeFile(folder_.Path(name + "/results.csv"), 1 << 20).value();
    return text.substr(0, text.find('\n'));
  };
  EXPECT_THAT(header("one"), ::testing::EndsWith(",request_hash"));
  EXPECT_EQ(header("several"),
            header("one") + ",candidates,candidates_lower,candidates_invalid");
  for (const CaseResult& r : ResultsOf("one")) EXPECT_EQ(r.candidates, 0);
}

TEST_F(RunTest, AFinishedRunIsNotRunAgain) {
  const auto run = Run("yes", [](const MethodInput&) {
    Attempt attempt;
    attempt.kind = AttemptKind::kRetain;
    return attempt;
  });
  RunOptions options;
  options.repeats = 2;
  ASSERT_TRUE(RunMethods(dataset_, options, {run}, {}).ok());
  EXPECT_EQ(calls_, 16);
  ASSERT_TRUE(RunMethods(dataset_, options, {run}, {}).ok());
  EXPECT_EQ(calls_, 16);
  const auto description = ReadRunDescription(folder_.Path("yes/run.json"));
  ASSERT_TRUE(description.ok());
  EXPECT_EQ(description->started.size(), 2U);
  EXPECT_FALSE(description->finished.empty());
}

TEST_F(RunTest, OnlyCasesWithoutAnAnswerAreAskedAgain) {
  const auto run = Run("flaky", [this](const MethodInput& input) {
    Attempt attempt;
    const bool down = calls_ <= 8 && input.dataset_case.group == "hard";
    attempt.kind = down ? AttemptKind::kNoAnswer : AttemptKind::kRetain;
    return attempt;
  });
  ASSERT_TRUE(RunMethods(dataset_, {}, {run}, {}).ok());
  EXPECT_EQ(calls_, 8);
  ASSERT_TRUE(RunMethods(dataset_, {}, {run}, {}).ok());
  EXPECT_EQ(calls_, 12);
  for (const CaseResult& r : ResultsOf("flaky")) {
    EXPECT_EQ(r.kind, AttemptKind::kRetain);
  }
}

TEST_F(RunTest, AFolderOfAnotherRunIsRefused) {
  ASSERT_TRUE(RunMethods(dataset_, {}, {Named("coarse", "", "out")}, {}).ok());
  RunOptions options;
  options.lattice.stride = 20;
  EXPECT_THAT(ErrorMessage(RunMethods(dataset_, options,
                                      {Named("coarse", "", "out")}, {})),
              HasSubstr("holds another run"));
}

TEST_F(RunTest, ShardsPartTheCases) {
  std::vector<std::string> ids;
  for (int i = 1; i <= 3; ++i) {
    RunOptions options;
    options.shard = {i, 3};
    const std::string out = "shard" + std::to_string(i);
    ASSERT_TRUE(
        RunMethods(dataset_, options, {Named("coarse", "", out)}, {}).ok());
    for (const CaseResult& r : ResultsOf(out)) ids.push_back(r.case_id);
  }
  EXPECT_EQ(ids.size(), 8U);
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 8U);
}

TEST_F(RunTest, TheFirstCasesOfEachGroupCanBeChosen) {
  RunOptions options;
  options.cases.first_of_each_group = 2;
  ASSERT_TRUE(
      RunMethods(dataset_, options, {Named("coarse", "", "out")}, {}).ok());
  EXPECT_THAT(IdsOf("out"),
              ElementsAre("easy_0000", "easy_0001", "hard_0000", "hard_0001"));
}

TEST_F(RunTest, ListedCasesStandInOrderOfTheDataset) {
  RunOptions options;
  options.cases.ids = {"hard_0002", "easy_0003", "easy_0001"};
  ASSERT_TRUE(
      RunMethods(dataset_, options, {Named("coarse", "", "out")}, {}).ok());
  EXPECT_THAT(IdsOf("out"), ElementsAre("easy_0001", "easy_0003", "hard_0002"));
  options.cases.ids.emplace_back("easy_0009");
  EXPECT_THAT(ErrorMessage(RunMethods(dataset_, options,
                                      {Named("coarse", "", "other")}, {})),
              HasSubstr("has no case 'easy_0009'"));
}

TEST_F(RunTest, ProgressNamesTheMethods) {
  EXPECT_EQ(
      ProgressTitle({Named("advisor", "search", "a"),
                     Named("advisor", "band", "b"), Named("coarse", "", "c")}),
      "run advisor search, advisor band, coarse");
}

TEST_F(RunTest, AFolderAboveRunsMayHoldOtherThings) {
  ASSERT_TRUE(RunMethods(dataset_, {},
                         {Named("coarse", "", "runs/coarse"),
                          Named("coarse", "", "runs/.old/coarse")},
                         {})
                  .ok());
  folder_.Write("runs/.DS_Store", "Bud1");
  folder_.Write("runs/coarse/._run.json", "Mac OS X");
  folder_.Write("runs/elsewhere/run.json", R"({"project": "other"})");
  std::filesystem::create_directories(folder_.Path("runs/odd/run.json"));
  std::vector<std::string> others;
  const auto runs = LoadRuns({folder_.Path("runs")}, &others);
  ASSERT_TRUE(runs.ok()) << ErrorMessage(runs);
  ASSERT_EQ(runs->size(), 1U);
  ASSERT_EQ(others.size(), 1U);
  EXPECT_THAT(others.front(), HasSubstr("elsewhere/run.json: not written by"));
  // A run that was named is meant.
  EXPECT_FALSE(LoadRuns({folder_.Path("runs/elsewhere")}).ok());
}

TEST_F(RunTest, UnknownMethodsAndBackendsAreNamedWithThoseThereAre) {
  EXPECT_THAT(ErrorMessage(FindDeterministicMethod("magic", "", false)),
              HasSubstr("there are advisor, coarse"));
  EXPECT_THAT(ErrorMessage(FindDeterministicMethod("advisor", "x", false)),
              HasSubstr("search"));
  EXPECT_THAT(ErrorMessage(FindDeterministicMethod("direct", "search", false)),
              HasSubstr("direct asks a model"));
  EXPECT_THAT(ErrorMessage(FindDeterministicMethod("coarse", "search", false)),
              HasSubstr("coarse takes no backend 'search'"));
}

TEST_F(RunTest, AMissingMapEndsTheRunWithItsName) {
  std::filesystem::remove(folder_.Path("data/maps/hard_0002.png"));
  EXPECT_THAT(
      ErrorMessage(RunMethods(dataset_, {}, {Named("coarse", "", "out")}, {})),
      HasSubstr("hard_0002.png"));
}

TEST_F(RunTest, KeepsWhenReplayedAnswersWereRecorded) {
  int call = 0;
  const auto replay = [&](const MethodInput&) {
    Attempt attempt = Propose({});
    attempt.recorded_at =
        ++call == 3 ? "2026-01-02T00:00:00Z"
                    : "2026-01-0" + std::to_string(3 + call) + "T00:00:00Z";
    return attempt;
  };
  RunOptions options;
  options.jobs = 1;
  options.cases.first_of_each_group = 2;
  ASSERT_TRUE(RunMethods(dataset_, options, {Run("replay", replay)}, {}).ok());
  const RunDescription run =
      ReadRunDescription(folder_.Path("replay/run.json")).value();
  EXPECT_EQ(run.recorded.first, "2026-01-02T00:00:00Z");
  EXPECT_EQ(run.recorded.last, "2026-01-07T00:00:00Z");
}

TEST_F(RunTest, AResumedRunHasTheMostJobsOfItsParts) {
  const auto nothing = [](const MethodInput&) {
    return Attempt{};
  };
  for (const int jobs : {2, 1}) {
    RunOptions options;
    options.jobs = jobs;
    ASSERT_TRUE(RunMethods(dataset_, options, {Run("x", nothing)}, {}).ok());
    EXPECT_EQ(ReadRunDescription(folder_.Path("x/run.json")).value().jobs, 2);
  }
}

}  // namespace
}  // namespace terra::benchmark

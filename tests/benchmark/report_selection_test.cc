#include "benchmark/report_selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/detail_tables.h"
#include "benchmark/paper_tables.h"
#include "benchmark/run_labels.h"
#include "benchmark/switch_tables.h"

namespace terra::benchmark {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

void SetScores(LoadedRun& run, std::vector<Score> scores) {
  run.read = ReaderOf(std::move(scores));
  EXPECT_TRUE(SumUp(run).ok());
}

// A refiner's run on the first n cases of both subsets.
LoadedRun Refiner(const std::string& folder, const std::string& backend, int n,
                  int jobs = 2) {
  LoadedRun run;
  run.folder = folder;
  RunDescription& d = run.description;
  d.method = "advisor";
  d.backend = d.title = backend;
  d.dataset_digest = "maps";
  d.case_list_digest = "first " + std::to_string(n);
  d.num_cases = 2 * n;
  d.stride = 50;
  d.joints = "2r";
  d.settings_json = "{}";
  d.jobs = jobs;
  std::vector<Score> scores;
  for (const std::string group : {"easy", "hard"}) {
    for (int i = 0; i < n; ++i) {
      Score score;
      score.case_id = group + std::to_string(i);
      score.group = group;
      score.kind = AttemptKind::kPropose;
      score.baseline_cost = 100;
      score.oracle_cost = score.final_cost = 90;
      scores.push_back(score);
    }
  }
  SetScores(run, std::move(scores));
  return run;
}

std::vector<Score> ScoresOf(const LoadedRun& run) {
  std::vector<Score> scores;
  EXPECT_TRUE(run.read([&](const Score& score) {
                   scores.push_back(score);
                 })
                  .ok());
  return scores;
}

LoadedRun Model(const std::string& folder, int n, const std::string& settings) {
  LoadedRun run = Refiner(folder, "openai", n, 1);
  run.description.asks_model = true;
  run.description.settings_json = settings;
  return run;
}

std::vector<std::string> Folders(const std::vector<LoadedRun>& runs) {
  std::vector<std::string> folders;
  for (const LoadedRun& run : runs) folders.push_back(run.folder);
  return folders;
}

TEST(SelectRuns, ARunMadeTwiceStandsOnceWithTheTimesOfOneCaseAtATime) {
  const Selection s =
      SelectRuns({Refiner("a", "shortcut", 5, 2), Refiner("b", "band", 5, 2),
                  Refiner("c", "shortcut", 5, 1),
                  Refiner("d", "shortcut", 5, 1)})
          .value();
  EXPECT_THAT(Folders(s.comparison), ElementsAre("c", "b"));
  EXPECT_THAT(Folders(s.gap), ElementsAre("c", "b"));
  EXPECT_THAT(Folders(s.latency), ElementsAre("c"));
  EXPECT_THAT(s.others, IsEmpty());
}

TEST(SumUp, OfMoreCasesThanAreKeptAtOnceTakesASample) {
  LoadedRun run = Refiner("a", "search", 300);
  std::vector<Score> scores = ScoresOf(run);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores[i].t_prep = static_cast<double>(i);
  }
  SetScores(run, scores);
  const Metrics all = MetricsOf(run, "easy");
  ASSERT_TRUE(SumUp(run, 100).ok());
  const Metrics sampled = MetricsOf(run, "easy");
  EXPECT_EQ(sampled.paths, 300);
  EXPECT_EQ(sampled.lower, all.lower);
  EXPECT_DOUBLE_EQ(sampled.mogr->value, all.mogr->value);
  EXPECT_NE(*sampled.prep_median, *all.prep_median);
  EXPECT_NEAR(*sampled.prep_median, *all.prep_median, 60);
}

TEST(SelectRuns, LatencyRowsTookOneCaseAtATimeOnTheSameCases) {
  LoadedRun elsewhere = Refiner("elsewhere", "search", 3, 1);
  elsewhere.description.dataset_digest = "other maps";
  LoadedRun coarser = Refiner("coarser", "search", 4, 1);
  coarser.description.stride = 100;
  const Selection s = SelectRuns({Refiner("many jobs", "search", 9, 2),
                                  Refiner("few", "search", 4, 1),
                                  Model("model", 9, "{}"), elsewhere, coarser})
                          .value();
  EXPECT_THAT(Folders(s.latency), UnorderedElementsAre("few", "model"));
  for (const LoadedRun& run : s.latency) EXPECT_EQ(run.num_rows, 8);
  EXPECT_THAT(Folders(s.comparison), ElementsAre("many jobs", "model"));
  EXPECT_EQ(s.comparison.front().num_rows, 18);
  ASSERT_EQ(s.others.size(), 2U);
  EXPECT_THAT(Folders(s.others[0]), ElementsAre("elsewhere"));
  EXPECT_THAT(Folders(s.others[1]), ElementsAre("coarser"));
}

TEST(SelectRuns, AblationAndNoiseDoNotMixDatasets) {
  LoadedRun elsewhere = Model("elsewhere", 3, "{}");
  elsewhere.description.dataset_digest = "other maps";
  const Selection s = SelectRuns({elsewhere, Model("full", 9, "{}"),
                                  Model("bare", 9, R"({"rea":false})"),
                                  Model("noisy", 4, R"({"noise":5})")})
                          .value();
  EXPECT_THAT(Folders(s.ablation), UnorderedElementsAre("full", "bare"));
  EXPECT_THAT(Folders(s.noise), UnorderedElementsAre("full", "noisy"));
  for (const LoadedRun& run : s.noise) EXPECT_EQ(run.num_rows, 8);
  EXPECT_THAT(Folders(s.comparison), ElementsAre("full"));
  ASSERT_EQ(s.others.size(), 1U);
  EXPECT_THAT(Folders(s.others[0]), ElementsAre("elsewhere"));
}

TEST(SelectRuns, RunsOfAnotherCostModelStandApart) {
  LoadedRun tight = Refiner("tight", "shortcut", 5);
  tight.description.corner_cutting = false;
  tight.description.stride = 10;
  const Selection s =
      SelectRuns({Refiner("main", "shortcut", 5), tight}).value();
  EXPECT_THAT(Folders(s.gap), ElementsAre("main"));
  EXPECT_THAT(Folders(s.others.at(0)), ElementsAre("tight"));
}

TEST(SelectRuns, OfNothingIsNothing) {
  const Selection s = SelectRuns({}).value();
  EXPECT_THAT(s.comparison, IsEmpty());
  EXPECT_THAT(s.latency, IsEmpty());
  EXPECT_THAT(s.others, IsEmpty());
}

std::string TextOfMismatch(const LoadedRun& a, const LoadedRun& b) {
  const auto mismatch = FindMismatch(a, b).value();
  return mismatch ? mismatch->text : "";
}

TEST(FindMismatch, NamesTheCaseWithAnotherBaseline) {
  const LoadedRun a = Refiner("a", "search", 3);
  LoadedRun b = Refiner("b", "shortcut", 3);
  EXPECT_EQ(TextOfMismatch(a, b), "");
  std::vector<Score> scores = ScoresOf(b);
  // Other order, a row less: still the same cases where both have them.
  std::swap(scores[0], scores[4]);
  scores.pop_back();
  SetScores(b, scores);
  EXPECT_FALSE(b.complete());
  EXPECT_EQ(TextOfMismatch(a, b), "");
  scores[2].baseline_cost = 101;
  SetScores(b, scores);
  EXPECT_EQ(TextOfMismatch(a, b),
            "a and b differ in their map or baseline of case easy2");
  scores[2].baseline_cost = 100;
  scores[3].map_id = 7;
  SetScores(b, scores);
  EXPECT_EQ(TextOfMismatch(a, b),
            "a and b differ in their map or baseline of case hard0");
}

TEST(FindMismatch, AnUnreadableRunIsAnErrorAndNoMismatch) {
  LoadedRun gone = Refiner("gone", "search", 3);
  gone.cases_digest = 1;
  gone.read = [](const std::function<void(const Score&)>&) -> Status {
    return Error{ErrorCode::kNotFound, "gone/results.csv: no such file"};
  };
  EXPECT_FALSE(FindMismatch(Refiner("a", "search", 3), gone).ok());
  EXPECT_FALSE(SelectRuns({Refiner("a", "shortcut", 3), gone}).ok());
}

TEST(FindMismatch, WhatATableVariesHidesNothingElse) {
  const LoadedRun a = Refiner("a", "search", 3);
  LoadedRun b = Refiner("b", "search", 4);
  b.description.stride = 20;
  b.description.joints = "cell";
  EXPECT_EQ(FindMismatch(a, b).value()->what, Shared::kCaseList);
  EXPECT_EQ(FindMismatch(a, b, {Shared::kCaseList}).value()->what,
            Shared::kStride);
  EXPECT_EQ(
      FindMismatch(a, b, {Shared::kCaseList, Shared::kStride}).value()->what,
      Shared::kJoints);
}

TEST(SortRows, PutsTheBoundsLast) {
  LoadedRun oracle = Refiner("oracle", "", 1);
  oracle.description.method = "oracle";
  LoadedRun coarse = Refiner("coarse", "", 1);
  coarse.description.method = "coarse";
  std::vector<LoadedRun> runs = {oracle, Refiner("search", "search", 1),
                                 Refiner("band", "band", 1),
                                 Model("model", 1, "{}"), coarse};
  SortRows(runs);
  EXPECT_THAT(Folders(runs),
              ElementsAre("coarse", "model", "band", "search", "oracle"));
}

TEST(LatencyTable, SaysHowManyCallsOfAModelACaseTakes) {
  const std::string text = ToCsv(LatencyTable(
      {Model("once", 1, "{}"), Model("rounds", 1, R"({"rounds":3})"),
       Refiner("none", "search", 1, 1)}));
  EXPECT_THAT(text, HasSubstr("easy,1,1,"));
  EXPECT_THAT(text, HasSubstr("easy,1,1 to 3,"));
  EXPECT_THAT(text, HasSubstr("search,easy,1,0,"));
}

TEST(ProposalTable, HasColumnsForCandidatesWhereAnAnswerMayHaveSeveral) {
  LoadedRun several = Model("several", 1, R"({"candidates":4})");
  std::vector<Score> scores = ScoresOf(several);
  scores[0].candidates = 4;
  scores[0].candidates_lower = 1;
  SetScores(several, std::move(scores));
  const LoadedRun one = Model("one", 1, "{}");
  const std::string both = ToCsv(ProposalTable({one, several}, "easy"));
  EXPECT_THAT(both, HasSubstr(",Candidates,ASR per candidate %,"));
  EXPECT_THAT(both, HasSubstr(",-,-,,,-,,\n"));
  EXPECT_THAT(both, HasSubstr(",4,25.00,4.56,69.94,0.00,0.00,48.99\n"));
  EXPECT_THAT(ToCsv(ProposalTable({one}, "easy")),
              ::testing::Not(HasSubstr("andidate")));
}

TEST(ProposalTable, ShowsHowAnswersVaryOverRepeats) {
  // One case of each group, asked twice: lower, then not.
  LoadedRun repeated = Model("repeated", 1, "{}");
  repeated.description.repeats = 2;
  std::vector<Score> scores = ScoresOf(repeated);
  for (const Score& first : ScoresOf(repeated)) {
    scores.push_back(first);
    scores.back().repeat = 1;
    scores.back().final_cost = 100;
  }
  SetScores(repeated, std::move(scores));
  const LoadedRun once = Model("once", 1, "{}");
  const std::string text = ToCsv(ProposalTable({once, repeated}, "easy"));
  EXPECT_THAT(text,
              HasSubstr(",Repeats,FIR over repeats %,Cases that vary %\n"));
  EXPECT_THAT(text, HasSubstr(",1,-,-\n"));
  EXPECT_THAT(text, HasSubstr(",2,50.00,100.00\n"));
  EXPECT_THAT(ToCsv(ProposalTable({once}, "easy")),
              ::testing::Not(HasSubstr("Repeats")));
}

// The rows of a table that begin with these cells.
std::vector<std::string> RowsWith(const Table& table,
                                  const std::string& first) {
  std::vector<std::string> rows;
  for (const TableBlock& block : table.blocks) {
    for (const auto& row : block.rows) {
      if (block.published || row.front().text != first) continue;
      rows.push_back(row.back().text);
    }
  }
  return rows;
}

TEST(AblationTable, HasOnlyRunsWhoseOtherSettingsAreThePapers) {
  const std::string paper = R"({"provider":"openai","model":"gpt-5.5")";
  std::vector<LoadedRun> runs;
  for (const char* beyond :
       {R"("axes":true)", R"("regions":true)", R"("stretches":true)",
        R"("candidates":3)", R"("rounds":2)", R"("polish":true)",
        R"("noise":5)", R"("model_settings":{"effort":"high"})",
        R"("temperature":0.7)"}) {
    runs.push_back(Model(beyond, 2, paper + "," + beyond + "}"));
    EXPECT_FALSE(IsOfAblation(runs.back())) << beyond;
  }
  const Table none = AblationTable(runs);
  ASSERT_EQ(RowsWith(none, "full advisor").size(), 1U);
  EXPECT_THAT(RowsWith(none, "full advisor").front(),
              HasSubstr("not measured"));
  EXPECT_THAT(none.notes.back(), HasSubstr("effort high"));
  // Nor do they stand for a row of the main comparison.
  EXPECT_EQ(
      RowsWith(ComparisonTable(runs, "easy"), "LLM-Advisor (gpt-5.5)").size(),
      1U);
  runs.push_back(Model("full", 2, paper + "}"));
  runs.push_back(Model("bare", 2, paper + R"(,"overlay":false})"));
  const Table both = AblationTable(runs);
  EXPECT_EQ(RowsWith(both, "full advisor").size(), 2U);  // Of two subsets.
  EXPECT_EQ(RowsWith(both, "without overlay").size(), 2U);
  EXPECT_EQ(
      RowsWith(ComparisonTable(runs, "easy"), "LLM-Advisor (gpt-5.5)").size(),
      0U);
}

TEST(OracleGapTable, MixesInNeitherNoiseNorAblation) {
  const std::string paper = R"({"provider":"openai","model":"gpt-5.5")";
  LoadedRun other = Refiner("other stride", "shortcut", 2);
  other.description.stride = 20;
  const std::vector<LoadedRun> runs = {
      Model("full", 2, paper + "}"),
      Model("noisy", 2, paper + R"(,"noise":5})"),
      Model("bare", 2, paper + R"(,"rea":false})"), other};
  const Table table = OracleGapTable(runs);
  EXPECT_EQ(table.blocks.front().rows.size(), 4U);
  EXPECT_THAT(table.notes.back(),
              AllOf(HasSubstr("noisy: "), HasSubstr("bare: ")));
  const Selection s = SelectRuns(runs).value();
  EXPECT_THAT(Folders(s.comparison), ElementsAre("full"));
  EXPECT_THAT(Folders(s.gap), ElementsAre("full", "other stride"));
  EXPECT_THAT(Folders(s.ablation), ElementsAre("full", "bare"));
  EXPECT_THAT(Folders(s.noise), ElementsAre("full", "noisy"));
  EXPECT_THAT(s.others, IsEmpty());
}

TEST(OracleGapTable, NamesThePapersRowsThatWereNotMeasured) {
  const LoadedRun full =
      Model("full", 2, R"({"provider":"openai","model":"gpt-5.5"})");
  const std::string text = ToCsv(OracleGapTable({full}));
  EXPECT_THAT(text, HasSubstr("Not measured here,hard,10,LLM-Advisor "
                              "(gpt-5.5),not measured; OPENAI_API_KEY=... "));
  EXPECT_THAT(text, HasSubstr("--stride 100 --out "));
  // At 50 it was, of both subsets.
  EXPECT_THAT(text, Not(HasSubstr("here,easy,50,LLM-Advisor (gpt-5.5)")));
  EXPECT_THAT(text, Not(HasSubstr("here,hard,50,LLM-Advisor (gpt-5.5)")));
  const std::string empty = ToCsv(OracleGapTable({}));
  EXPECT_THAT(empty, HasSubstr("here,easy,50,LLM-Advisor (gpt-5.5),not mea"));
}

TEST(ComparisonTable, ARunWithoutCasesOfASubsetMeasuredNoRowOfIt) {
  LoadedRun hard =
      Model("hard", 2, R"({"provider":"openai","model":"gpt-5.5"})");
  std::vector<Score> scores = ScoresOf(hard);
  std::erase_if(scores, [](const Score& score) {
    return score.group == "easy";
  });
  SetScores(hard, scores);
  const std::string row = "LLM-Advisor (gpt-5.5)";
  EXPECT_EQ(RowsWith(ComparisonTable({hard}, "hard"), row).size(), 0U);
  EXPECT_EQ(RowsWith(ComparisonTable({hard}, "easy"), row).size(), 1U);
}

TEST(NoiseTable, ShowsEveryPercentage) {
  const std::string text = ToCsv(
      NoiseTable({Model("7", 2, R"({"noise":7.5})"), Model("0", 2, "{}")}));
  EXPECT_THAT(text, HasSubstr(",easy,7.5,"));
  EXPECT_LT(text.find(",easy,0,"), text.find(",easy,7.5,"));
}

TEST(SelectRuns, OfARowMadeTwiceACompleteRunCounts) {
  LoadedRun shard = Refiner("a shard", "shortcut", 5, 1);
  std::vector<Score> scores = ScoresOf(shard);
  scores.resize(4);
  SetScores(shard, scores);
  const Selection s =
      SelectRuns({shard, Refiner("whole", "shortcut", 5, 2)}).value();
  EXPECT_THAT(Folders(s.comparison), ElementsAre("whole"));
}

TEST(SelectRuns, RunsOfOneConfigurationWithDifferentModelsAreTwoRows) {
  LoadedRun first = Model("first", 2, "{}");
  LoadedRun second = Model("second", 2, "{}");
  first.description.models = {"gpt-5.5-2026-04-23"};
  second.description.models = {"gpt-5.5-2026-10-01"};
  EXPECT_TRUE(first.description.SameFigures(second.description));
  EXPECT_THAT(Folders(SelectRuns({first, second}).value().comparison),
              ElementsAre("first", "second"));
}

TEST(RowTitle, OfARecordingSaysWhenItWasMade) {
  LoadedRun run = Model("replay", 1, R"({"model":"asked"})");
  run.description.models = {"answered"};
  run.description.recorded = {"2026-01-31T23:59:59Z", "2026-01-31T23:59:59Z"};
  EXPECT_EQ(RowTitle(run),
            "openai: answered (asked for asked of openai; recorded "
            "2026-01-31)");
  run.description.recorded.Add(std::string("2026-02-02T00:00:00Z"));
  EXPECT_THAT(RowTitle(run), HasSubstr("recorded 2026-01-31 to 2026-02-02)"));
}

}  // namespace
}  // namespace terra::benchmark

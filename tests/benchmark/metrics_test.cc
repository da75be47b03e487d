#include "benchmark/metrics.h"

#include <gtest/gtest.h>

#include "benchmark/comparison.h"

namespace terra::benchmark {
namespace {

constexpr CountingRule kAdvisor{.fallback = true, .every_case_attempts = false};
constexpr CountingRule kRefiner{.fallback = true, .every_case_attempts = true};
constexpr CountingRule kDirect{.fallback = false, .every_case_attempts = true};

// A case with baseline 100 and oracle 80.
Score Case(const std::string& id, AttemptKind kind, double final_cost,
           bool invalid = false) {
  Score score;
  score.case_id = id;
  score.kind = kind;
  score.form =
      kind == AttemptKind::kPropose ? AnswerStyle::kExact : AnswerStyle::kNone;
  score.invalid_code = invalid;
  score.baseline_cost = 100;
  score.oracle_cost = 80;
  score.final_cost = final_cost;
  return score;
}

// Eight answers of an advisor: two accepted (90, 80), one dearer and one equal
// (both fall back), one through an obstacle, one malformed, one Yes, none.
std::vector<Score> AdvisorScores() {
  return {Case("a", AttemptKind::kPropose, 90),
          Case("b", AttemptKind::kPropose, 80),
          Case("c", AttemptKind::kPropose, 100),
          Case("d", AttemptKind::kPropose, 100),
          Case("e", AttemptKind::kPropose, 100, true),
          Case("f", AttemptKind::kMalformed, 100, true),
          Case("g", AttemptKind::kRetain, 100),
          Case("h", AttemptKind::kNoAnswer, 100)};
}

TEST(Metrics, OfAnAdvisorAreAsHandComputed) {
  const Metrics m = ComputeMetrics(AdvisorScores(), kAdvisor);
  EXPECT_EQ(m.paths, 8);
  EXPECT_EQ(m.suggested, 6);  // Neither the Yes nor the missing answer.
  EXPECT_EQ(m.lower, 2);
  EXPECT_EQ(m.invalid, 2);
  EXPECT_EQ(m.non_improving(), 2);  // The tie is one of them.
  EXPECT_EQ(m.no_answer, 1);
  EXPECT_DOUBLE_EQ(m.asr->value, 2.0 / 6);
  EXPECT_DOUBLE_EQ(m.isr->value, 2.0 / 6);
  EXPECT_DOUBLE_EQ(m.vnsr->value, 2.0 / 6);
  EXPECT_DOUBLE_EQ(m.fir->value, 2.0 / 8);
  EXPECT_DOUBLE_EQ(m.acr->value, (0.10 + 0.20) / 2);
  EXPECT_DOUBLE_EQ(m.validity->value, 1);
  EXPECT_DOUBLE_EQ(m.ndr->value, 1);
  EXPECT_EQ(m.comparable, 8);
  EXPECT_EQ(m.gaps, 8);
  EXPECT_DOUBLE_EQ(m.mean_gap->value, 0.2);
  EXPECT_DOUBLE_EQ(m.mogr->value, (0.5 + 1.0) / 8);  // Fallback recovers 0.
}

TEST(Metrics, WithoutFallbackEveryCaseIsAnAttempt) {
  // 90 lower, 100 a tie, 130 dearer, two invalid, no answer invalid as well.
  const std::vector<Score> scores = {
      Case("a", AttemptKind::kPropose, 90),
      Case("b", AttemptKind::kPropose, 100),
      Case("c", AttemptKind::kPropose, 130),
      Case("d", AttemptKind::kPropose, kImpassable, true),
      Case("e", AttemptKind::kMalformed, kImpassable, true),
      Case("f", AttemptKind::kNoAnswer, kImpassable)};
  const Metrics m = ComputeMetrics(scores, kDirect);
  EXPECT_EQ(m.suggested, 6);
  EXPECT_EQ(m.invalid, 3);
  EXPECT_EQ(m.lower, 1);
  EXPECT_EQ(m.non_improving(), 2);
  EXPECT_DOUBLE_EQ(m.validity->value, 3.0 / 6);
  EXPECT_DOUBLE_EQ(m.ndr->value, 2.0 / 6);  // The tie counts, 130 does not.
  EXPECT_DOUBLE_EQ(m.fir->value, 1.0 / 6);
  EXPECT_EQ(m.comparable, 3);  // Final route must be valid.
  EXPECT_FALSE(m.mogr.has_value());
}

TEST(Metrics, CompareCostsWithATolerance) {
  Score barely = Case("a", AttemptKind::kPropose, 100 - 0.9e-6);
  EXPECT_FALSE(CountCase(barely, kDirect).lower);
  EXPECT_TRUE(CountCase(barely, kDirect).non_degraded);
  barely.final_cost = 100 - 1.1e-6;
  EXPECT_TRUE(CountCase(barely, kDirect).lower);
  barely.final_cost = 100 + 0.9e-6;
  EXPECT_TRUE(CountCase(barely, kDirect).non_degraded);
  barely.final_cost = 100 + 1.1e-6;
  EXPECT_FALSE(CountCase(barely, kDirect).non_degraded);
}

TEST(Metrics, MapsWithoutAGapAreLeftOutOfGapAndRecovery) {
  std::vector<Score> scores = {Case("a", AttemptKind::kPropose, 90),
                               Case("b", AttemptKind::kPropose, 100)};
  scores[1].oracle_cost = 100;
  const Metrics m = ComputeMetrics(scores, kRefiner);
  EXPECT_EQ(m.comparable, 2);
  EXPECT_EQ(m.gaps, 1);
  EXPECT_DOUBLE_EQ(m.gap_rate->value, 0.5);
  EXPECT_DOUBLE_EQ(m.mean_gap->value, 0.2);
  EXPECT_DOUBLE_EQ(m.mogr->value, 0.5);
}

TEST(Metrics, CasesWithoutABaselineAreNotCounted) {
  std::vector<Score> scores = {Case("a", AttemptKind::kPropose, 90),
                               Case("b", AttemptKind::kNoBaseline, 0)};
  scores[1].baseline_cost = scores[1].final_cost = kImpassable;
  const Metrics m = ComputeMetrics(scores, kRefiner);
  EXPECT_EQ(m.paths, 1);
  EXPECT_EQ(m.without_baseline, 1);
  EXPECT_EQ(m.suggested, 1);
}

TEST(Metrics, OfNothingAreAbsent) {
  const Metrics empty = ComputeMetrics({}, kRefiner);
  EXPECT_FALSE(empty.fir || empty.asr || empty.acr || empty.mogr || empty.fps);
  const Metrics only_yes =
      ComputeMetrics({Case("a", AttemptKind::kRetain, 100)}, kAdvisor);
  EXPECT_FALSE(only_yes.asr || only_yes.isr || only_yes.vnsr || only_yes.acr);
  EXPECT_EQ(only_yes.fir->value, 0);
}

TEST(Metrics, TolerantlyReadAnswersCountAsInvalidInTheStrictRate) {
  std::vector<Score> scores = AdvisorScores();
  scores[0].form = AnswerStyle::kTolerated;
  const Metrics m = ComputeMetrics(scores, kAdvisor);
  EXPECT_DOUBLE_EQ(m.isr->value, 2.0 / 6);
  EXPECT_DOUBLE_EQ(m.strict_isr->value, 3.0 / 6);
}

TEST(Metrics, CandidatesHaveRatesOfTheirOwn) {
  // Three cases, one attempt each; 3 + 2 + 0 candidates, of which 2 are lower
  // and 1 is invalid.
  std::vector<Score> scores = {Case("a", AttemptKind::kPropose, 90),
                               Case("b", AttemptKind::kPropose, 100, true),
                               Case("c", AttemptKind::kMalformed, 100, true)};
  scores[0].candidates = 3;
  scores[0].candidates_lower = 2;
  scores[1].candidates = 2;
  scores[1].candidates_invalid = 1;
  const Metrics m = ComputeMetrics(scores, kAdvisor);
  EXPECT_EQ(m.suggested, 3);
  EXPECT_DOUBLE_EQ(m.asr->value, 1.0 / 3);
  EXPECT_EQ(m.candidates, 5);
  EXPECT_DOUBLE_EQ(m.candidate_asr->value, 2.0 / 5);
  EXPECT_DOUBLE_EQ(m.candidate_isr->value, 1.0 / 5);
  scores.pop_back();
  scores[0].candidates = scores[1].candidates = 0;
  EXPECT_FALSE(ComputeMetrics(scores, kAdvisor).candidate_asr.has_value());
}

TEST(Metrics, TimesAreMediansNearestRanksAndARate) {
  std::vector<Score> scores = AdvisorScores();
  scores.resize(4);
  for (std::size_t i = 0; i < 4; ++i) {
    scores[i].t_prep = 0.1;
    scores[i].t_llm = static_cast<double>(i + 1);
    scores[i].t_det = 0.4;
  }
  const Metrics m = ComputeMetrics(scores, kAdvisor);
  EXPECT_DOUBLE_EQ(*m.prep_median, 0.1);
  EXPECT_DOUBLE_EQ(*m.llm_median, 2.5);
  EXPECT_DOUBLE_EQ(*m.e2e_median, 3.0);
  EXPECT_DOUBLE_EQ(*m.e2e_p95, 4.5);
  EXPECT_DOUBLE_EQ(*m.fps, 4 / 12.0);
}

TEST(Metrics, OtherRepeatsAreShownApart) {
  // Case a: lower, not lower; case b: lower twice.
  std::vector<Score> scores = {Case("a", AttemptKind::kPropose, 90),
                               Case("a", AttemptKind::kPropose, 100),
                               Case("b", AttemptKind::kPropose, 90),
                               Case("b", AttemptKind::kPropose, 85)};
  scores[1].repeat = scores[3].repeat = 1;
  EXPECT_EQ(ComputeMetrics(scores, kRefiner).paths, 2);
  RepeatsBuilder repeats(kRefiner);
  for (const Score& score : scores) repeats.Add(score);
  const RepeatFigures figures = repeats.Figures();
  EXPECT_EQ(figures.repeats, 2);
  EXPECT_DOUBLE_EQ(figures.mean_lower, 0.75);
  EXPECT_DOUBLE_EQ(figures.unstable, 0.5);
}

TEST(Metrics, RatesHaveWilsonIntervals) {
  // 3 lower of 10: see the test of WilsonRate.
  std::vector<Score> scores;
  for (int i = 0; i < 10; ++i) {
    scores.push_back(
        Case("c" + std::to_string(i), AttemptKind::kPropose, i < 3 ? 90 : 100));
  }
  const Metrics m = ComputeMetrics(scores, kRefiner);
  for (const auto& rate : {m.fir, m.asr}) {
    EXPECT_NEAR(rate->low, 0.1077913, 1e-7);
    EXPECT_NEAR(rate->high, 0.6032219, 1e-7);
  }
  // 7 of 10 is the mirror image; 10 of 10 begins at 10 / (10 + z^2).
  EXPECT_NEAR(m.vnsr->low, 1 - 0.6032219, 1e-7);
  EXPECT_NEAR(m.ndr->low, 10 / 13.841459, 1e-6);
  EXPECT_NEAR(m.validity->low, 10 / 13.841459, 1e-6);
  EXPECT_NEAR(m.gap_rate->low, 10 / 13.841459, 1e-6);
  EXPECT_NEAR(m.isr->high, 3.841459 / 13.841459, 1e-6);
}

// Five pairs of cases, of which the first pair alone recovers its whole gap.
std::vector<Score> FivePairs() {
  std::vector<Score> scores;
  for (int i = 0; i < 10; ++i) {
    scores.push_back(
        Case("c" + std::to_string(i), AttemptKind::kPropose, i < 2 ? 80 : 90));
    scores.back().oracle_cost = i < 2 ? 80 : 90;
  }
  return scores;
}

std::vector<Score> BySequence(std::vector<Score> scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores[i].cluster = "trail-" + std::to_string(i / 2);
  }
  return scores;
}

TEST(Metrics, MeansAreResampledByCase) {
  // Of ten cases two have 0.2, the others 0.1. Their number in a resample is
  // binomial (10, 1/5): at most 4 with chance 0.967, at most 5 with 0.994; none
  // with 0.107.
  const Metrics m = ComputeMetrics(FivePairs(), kRefiner);
  for (const auto& mean : {m.acr, m.mean_gap}) {
    EXPECT_DOUBLE_EQ(mean->value, 0.12);
    EXPECT_NEAR(mean->low, 0.10, 1e-12);
    EXPECT_NEAR(mean->high, 0.15, 1e-12);
  }
}

TEST(Metrics, MeansOfRugdAreResampledBySequence) {
  // The first of five sequences has 0.2 twice. How often it is drawn is
  // binomial (5, 1/5), 97.5 % quantile 3: (3 x 0.2 + 2 x 0.1) / 5.
  const Metrics m = ComputeMetrics(BySequence(FivePairs()), kRefiner);
  for (const auto& mean : {m.acr, m.mean_gap}) {
    EXPECT_DOUBLE_EQ(mean->value, 0.12);
    EXPECT_NEAR(mean->low, 0.10, 1e-12);
    EXPECT_NEAR(mean->high, 0.16, 1e-12);
  }
}

TEST(Metrics, RecoveryOfRugdIsResampledBySequence) {
  // Recovered: all of the gap in the first sequence, half of it elsewhere.
  std::vector<Score> scores = FivePairs();
  for (Score& score : scores) score.oracle_cost = 80;
  const Metrics by_case = ComputeMetrics(scores, kRefiner);
  EXPECT_DOUBLE_EQ(by_case.mogr->value, 0.6);
  EXPECT_NEAR(by_case.mogr->high, (5 * 1 + 5 * 0.5) / 10, 1e-12);
  const Metrics by_sequence = ComputeMetrics(BySequence(scores), kRefiner);
  EXPECT_DOUBLE_EQ(by_sequence.mogr->value, 0.6);
  EXPECT_NEAR(by_sequence.mogr->low, 0.5, 1e-12);
  EXPECT_NEAR(by_sequence.mogr->high, (3 * 1 + 2 * 0.5) / 5, 1e-12);
}

TEST(Metrics, AnswersFromFilesHaveNoTimeOfTheModel) {
  std::vector<Score> scores = AdvisorScores();
  for (Score& score : scores) score.t_det = 0.5;
  scores[3].t_llm = kImpassable;
  const Metrics m = ComputeMetrics(scores, kAdvisor);
  EXPECT_DOUBLE_EQ(*m.det_median, 0.5);
  EXPECT_FALSE(m.llm_median || m.e2e_median || m.e2e_p95 || m.fps);
}

TEST(Metrics, TheSameCaseCountsInEveryStageOfTheTimes) {
  // 21 cases: p95 is the 20th of the sums, rank ceil(0.95 x 21).
  std::vector<Score> scores;
  for (int i = 1; i <= 21; ++i) {
    scores.push_back(Case("c" + std::to_string(i), AttemptKind::kRetain, 100));
    scores.back().t_prep = 22 - i;
    scores.back().t_det = 2 * i;
  }
  const Metrics m = ComputeMetrics(scores, kAdvisor);
  EXPECT_DOUBLE_EQ(*m.prep_median, 11);
  EXPECT_DOUBLE_EQ(*m.det_median, 22);
  EXPECT_DOUBLE_EQ(*m.e2e_median, 33);
  EXPECT_DOUBLE_EQ(*m.e2e_p95, 42);  // 22 + i, i = 20.
  EXPECT_DOUBLE_EQ(*m.fps, 21 / (21 * 33.0));
}

// Cases of every third id are lower, by one part in a thousand more each.
std::vector<Score> ManyCases(int count) {
  std::vector<Score> scores;
  for (int i = 0; i < count; ++i) {
    const bool lower = i % 3 == 0;
    scores.push_back(Case("case " + std::to_string(i), AttemptKind::kPropose,
                          lower ? 90 - 0.01 * i : 100));
    scores.back().oracle_cost = 80;
    scores.back().t_prep = scores.back().t_llm = scores.back().t_det = i;
  }
  return scores;
}

TEST(Metrics, OfASampleCountAllCasesAndMeanThemExactly) {
  const std::vector<Score> scores = ManyCases(900);
  const Metrics all = ComputeMetrics(scores, kRefiner);
  MetricsBuilder builder(kRefiner, {0, 4});
  for (const Score& score : scores) builder.Add(score);
  const Metrics sampled = builder.Finish();
  EXPECT_EQ(sampled.paths, 900);
  EXPECT_EQ(sampled.lower, 300);
  EXPECT_EQ(sampled.fir->value, all.fir->value);
  EXPECT_DOUBLE_EQ(sampled.acr->value, all.acr->value);
  EXPECT_DOUBLE_EQ(sampled.mogr->value, all.mogr->value);
  // A quarter of the cases: an interval about twice as wide, around the mean.
  const double width = all.mogr->high - all.mogr->low;
  const double wider = sampled.mogr->high - sampled.mogr->low;
  EXPECT_GT(wider, 1.5 * width);
  EXPECT_LT(wider, 2.7 * width);
  EXPECT_LT(sampled.mogr->low, all.mogr->value);
  EXPECT_GT(sampled.mogr->high, all.mogr->value);
  // The median time of 225 of the 900, by their ids: four standard errors.
  EXPECT_NEAR(*sampled.prep_median, *all.prep_median, 120);
  EXPECT_NE(*sampled.prep_median, *all.prep_median);
}

TEST(Metrics, OfASampleWithoutATermHaveNoMean) {
  // One of a hundred is lower, and it is not in the part.
  std::vector<Score> scores = ManyCases(100);
  for (Score& score : scores) score.final_cost = 100;
  scores[0].final_cost = 90;
  const CasePart other{CaseKey(scores[0].case_id) % 4 == 0 ? 1U : 0U, 4};
  MetricsBuilder builder(kRefiner, other);
  for (const Score& score : scores) builder.Add(score);
  const Metrics m = builder.Finish();
  EXPECT_EQ(m.lower, 1);
  EXPECT_FALSE(m.acr.has_value());
  EXPECT_TRUE(m.mogr.has_value());
}

Comparison Paired(const std::vector<Score>& first, const CountingRule& rule,
                  const std::vector<Score>& second,
                  const CountingRule& second_rule) {
  return ComparePaired(ReaderOf(first), rule, ReaderOf(second), second_rule)
      .value();
}

TEST(ComparePaired, ResamplesTheDifferencesBySequence) {
  // Differences of recovery: 0.5 in the first of five sequences, else 0.
  std::vector<Score> first = FivePairs();
  std::vector<Score> second = FivePairs();
  for (std::size_t i = 0; i < 10; ++i) {
    first[i].oracle_cost = second[i].oracle_cost = 80;
    second[i].final_cost = 90;
  }
  const Comparison by_case = Paired(first, kRefiner, second, kRefiner);
  EXPECT_DOUBLE_EQ(by_case.mogr_difference->value, 0.1);
  EXPECT_NEAR(by_case.mogr_difference->high, 5 * 0.5 / 10, 1e-12);
  const Comparison by_sequence =
      Paired(BySequence(first), kRefiner, BySequence(second), kRefiner);
  EXPECT_DOUBLE_EQ(by_sequence.mogr_difference->value, 0.1);
  EXPECT_NEAR(by_sequence.mogr_difference->low, 0, 1e-12);
  EXPECT_NEAR(by_sequence.mogr_difference->high, 3 * 0.5 / 5, 1e-12);
}

TEST(ComparePaired, GivesNoRecoveryToMethodsWithoutFallback) {
  const std::vector<Score> scores = FivePairs();
  EXPECT_FALSE(
      Paired(scores, kRefiner, scores, kDirect).mogr_difference.has_value());
}

TEST(ComparePaired, CountsTheCasesInWhichOnlyOneIsLower) {
  // Lower in: first a b c; second c d. Case e has only the second.
  const std::vector<Score> first = {Case("a", AttemptKind::kPropose, 90),
                                    Case("b", AttemptKind::kPropose, 90),
                                    Case("c", AttemptKind::kPropose, 80),
                                    Case("d", AttemptKind::kPropose, 100)};
  const std::vector<Score> second = {Case("d", AttemptKind::kPropose, 90),
                                     Case("c", AttemptKind::kPropose, 90),
                                     Case("b", AttemptKind::kRetain, 100),
                                     Case("a", AttemptKind::kRetain, 100),
                                     Case("e", AttemptKind::kPropose, 90)};
  const Comparison result = Paired(first, kRefiner, second, kAdvisor);
  EXPECT_EQ(result.cases, 4);
  EXPECT_EQ(result.only_first_lower, 2);
  EXPECT_EQ(result.only_second_lower, 1);
  EXPECT_DOUBLE_EQ(result.mcnemar_p, 1);
  // Recoveries: 0.5 0.5 1 0 against 0 0 0.5 0.5.
  EXPECT_DOUBLE_EQ(result.mogr_difference->value, 0.25);
}

TEST(ComparePaired, CountsTheSameInPartsAsAtOnce) {
  const std::vector<Score> first = ManyCases(500);
  std::vector<Score> second = ManyCases(400);
  for (std::size_t i = 0; i < second.size(); i += 2) second[i].final_cost = 95;
  const Comparison at_once = Paired(first, kRefiner, second, kRefiner);
  for (const std::int64_t at_a_time : {1, 7, 100, 499}) {
    const Comparison in_parts =
        ComparePaired(ReaderOf(first), kRefiner, ReaderOf(second), kRefiner,
                      std::ssize(first), at_a_time)
            .value();
    EXPECT_EQ(in_parts.cases, 400);
    EXPECT_EQ(in_parts.only_first_lower, at_once.only_first_lower);
    EXPECT_EQ(in_parts.only_second_lower, at_once.only_second_lower);
    EXPECT_EQ(in_parts.mcnemar_p, at_once.mcnemar_p);
    if (in_parts.mogr_difference) {
      EXPECT_NEAR(in_parts.mogr_difference->value,
                  at_once.mogr_difference->value, 1e-12);
    }
  }
}

}  // namespace
}  // namespace terra::benchmark

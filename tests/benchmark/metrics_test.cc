#include "benchmark/metrics.h"

#include <gtest/gtest.h>

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
  const RepeatFigures figures = ComputeRepeats(scores, kRefiner);
  EXPECT_EQ(figures.repeats, 2);
  EXPECT_DOUBLE_EQ(figures.mean_lower, 0.75);
  EXPECT_DOUBLE_EQ(figures.unstable, 0.5);
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
  const Comparison result = ComparePaired(first, kRefiner, second, kAdvisor);
  EXPECT_EQ(result.cases, 4);
  EXPECT_EQ(result.only_first_lower, 2);
  EXPECT_EQ(result.only_second_lower, 1);
  EXPECT_DOUBLE_EQ(result.mcnemar_p, 1);
  // Recoveries: 0.5 0.5 1 0 against 0 0 0.5 0.5.
  EXPECT_DOUBLE_EQ(result.mogr_difference->value, 0.25);
}

}  // namespace
}  // namespace terra::benchmark

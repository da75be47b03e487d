#include "benchmark/metrics.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "terrain/files/id_index.h"

namespace terra::benchmark {
namespace {

using verifier::StrictlyCheaper;

std::optional<Estimate> Rate(std::int64_t hits, std::int64_t n) {
  if (n == 0) return std::nullopt;
  return WilsonRate(hits, n);
}

}  // namespace

Score ToScore(const CaseResult& r) {
  return {r.case_id,
          r.group,
          r.sequence,
          r.map_id,
          r.kind,
          r.form,
          IsInvalidCode(r.code),
          r.baseline_cost,
          r.oracle_cost,
          r.final_cost,
          r.t_prep,
          r.t_llm,
          r.t_det,
          r.tokens_in,
          r.tokens_out,
          r.spend,
          r.repeat,
          r.candidates,
          r.candidates_lower,
          r.candidates_invalid};
}

std::uint64_t CaseKey(const std::string& case_id) {
  return HashOfId(case_id);
}

CaseCounts CountCase(const Score& score, const CountingRule& rule) {
  CaseCounts c;
  if (score.kind == AttemptKind::kNoBaseline) return c;
  const double baseline = score.baseline_cost;
  const double final_cost = score.final_cost;
  c.path = true;
  c.no_answer = score.kind == AttemptKind::kNoAnswer;
  c.suggested = rule.every_case_attempts ||
                score.kind == AttemptKind::kPropose ||
                score.kind == AttemptKind::kMalformed;
  c.invalid =
      c.suggested && (score.invalid_code ||
                      score.kind == AttemptKind::kMalformed || c.no_answer);
  c.tolerated =
      c.suggested && !c.invalid && score.form == AnswerStyle::kTolerated;
  c.final_valid = final_cost < kImpassable;
  c.lower = c.final_valid && StrictlyCheaper(final_cost, baseline);
  c.non_degraded = c.final_valid && final_cost <= baseline + verifier::kEpsilon;
  c.comparable = c.final_valid && score.oracle_cost < kImpassable;
  c.gap = c.comparable && StrictlyCheaper(score.oracle_cost, baseline);
  if (c.lower) c.reduction = (baseline - final_cost) / baseline;
  if (c.gap) {
    c.gap_size = (baseline - score.oracle_cost) / baseline;
    c.recovery = (baseline - final_cost) / (baseline - score.oracle_cost);
  }
  return c;
}

ScoreReader ReaderOf(std::vector<Score> scores) {
  const auto shared =
      std::make_shared<const std::vector<Score>>(std::move(scores));
  return [shared](const std::function<void(const Score&)>& use) -> Status {
    for (const Score& score : *shared) use(score);
    return Done{};
  };
}

void MetricsBuilder::Add(const Score& score) {
  if (score.repeat != 0) return;
  Metrics& m = metrics_;
  const CaseCounts c = CountCase(score, rule_);
  m.without_baseline += c.path ? 0 : 1;
  if (!c.path) return;
  ++m.paths;
  m.suggested += c.suggested ? 1 : 0;
  m.invalid += c.invalid ? 1 : 0;
  m.tolerated += c.tolerated ? 1 : 0;
  m.no_answer += c.no_answer ? 1 : 0;
  m.lower += c.lower ? 1 : 0;
  m.final_valid += c.final_valid ? 1 : 0;
  m.non_degraded += c.non_degraded ? 1 : 0;
  m.comparable += c.comparable ? 1 : 0;
  m.gaps += c.gap ? 1 : 0;
  m.candidates += score.candidates;
  m.candidates_lower += score.candidates_lower;
  m.candidates_invalid += score.candidates_invalid;
  m.tokens_in += score.tokens_in;
  m.tokens_out += score.tokens_out;
  m.spend += score.spend;
  const bool sampled = sample_.Takes(CaseKey(score.case_id));
  acr_.Add(score.cluster, c.lower, c.reduction, sampled);
  mean_gap_.Add(score.cluster, c.gap, c.gap_size, sampled);
  mogr_.Add(score.cluster, c.gap, c.recovery, sampled);
  if (!sampled) return;
  t_prep_.push_back(score.t_prep);
  t_llm_.push_back(score.t_llm);
  t_det_.push_back(score.t_det);
}

Metrics MetricsBuilder::Finish() {
  Metrics& m = metrics_;
  MeasureTimes();
  m.acr = acr_.Mean();
  m.mean_gap = mean_gap_.Mean();
  if (rule_.fallback) m.mogr = mogr_.Mean();
  m.asr = Rate(m.lower, m.suggested);
  m.isr = Rate(m.invalid, m.suggested);
  m.strict_isr = Rate(m.invalid + m.tolerated, m.suggested);
  m.vnsr = Rate(m.non_improving(), m.suggested);
  m.fir = Rate(m.lower, m.paths);
  m.validity = Rate(m.final_valid, m.paths);
  m.ndr = Rate(m.non_degraded, m.paths);
  m.gap_rate = Rate(m.gaps, m.comparable);
  m.candidate_asr = Rate(m.candidates_lower, m.candidates);
  m.candidate_isr = Rate(m.candidates_invalid, m.candidates);
  return std::move(metrics_);
}

void MetricsBuilder::MeasureTimes() {
  if (t_prep_.empty()) return;
  Metrics& m = metrics_;
  std::vector<double> e2e(t_prep_.size());
  for (std::size_t i = 0; i < e2e.size(); ++i) {
    e2e[i] = t_prep_[i] + t_llm_[i] + t_det_[i];
  }
  const double total = std::accumulate(e2e.begin(), e2e.end(), 0.0);
  m.prep_median = Median(std::move(t_prep_));
  m.det_median = Median(std::move(t_det_));
  if (!std::isfinite(total)) return;  // Answers from files have no time.
  m.llm_median = Median(std::move(t_llm_));
  m.e2e_p95 = NearestRank(e2e, 95);
  const auto n = static_cast<double>(e2e.size());
  m.e2e_median = Median(std::move(e2e));
  if (total > 0) m.fps = n / total;
}

Metrics ComputeMetrics(const std::vector<Score>& scores,
                       const CountingRule& rule) {
  MetricsBuilder builder(rule);
  for (const Score& score : scores) builder.Add(score);
  return builder.Finish();
}

void RepeatsBuilder::Add(const Score& score) {
  const CaseCounts c = CountCase(score, rule_);
  if (!c.path || !sample_.Takes(CaseKey(score.case_id))) return;
  Tally& tally = tallies_[score.case_id];
  ++tally.repeats;
  tally.lower += c.lower ? 1 : 0;
}

RepeatFigures RepeatsBuilder::Figures() const {
  RepeatFigures figures;
  for (const auto& [id, tally] : tallies_) {
    figures.repeats = std::max(figures.repeats, tally.repeats);
    figures.mean_lower += static_cast<double>(tally.lower) / tally.repeats;
    figures.unstable += tally.lower != 0 && tally.lower != tally.repeats;
  }
  if (!tallies_.empty()) {
    figures.mean_lower /= static_cast<double>(tallies_.size());
    figures.unstable /= static_cast<double>(tallies_.size());
  }
  return figures;
}

}  // namespace terra::benchmark

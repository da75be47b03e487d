#include "benchmark/metrics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <unordered_map>

#include "terrain/require.h"

namespace terra::benchmark {
namespace {

using verifier::StrictlyCheaper;

// A mean over cases; those of one cluster are drawn together.
class ClusteredMean {
 public:
  void Add(const Score& score, bool counts, double value) {
    const std::size_t place = PlaceOf(score.cluster);
    if (!counts) return;
    clusters_[place].sum += value;
    ++clusters_[place].count;
    ++count_;
  }

  std::optional<Estimate> Mean() const {
    if (count_ == 0) return std::nullopt;
    return BootstrapMean(clusters_);
  }

 private:
  // A case without a cluster is one of its own.
  std::size_t PlaceOf(const std::string& cluster) {
    if (cluster.empty()) {
      clusters_.emplace_back();
      return clusters_.size() - 1;
    }
    const auto [found, added] = place_of_.emplace(cluster, clusters_.size());
    if (added) clusters_.emplace_back();
    return found->second;
  }

  std::vector<Cluster> clusters_;
  std::unordered_map<std::string, std::size_t> place_of_;
  std::int64_t count_ = 0;
};

std::optional<Estimate> Rate(std::int64_t hits, std::int64_t n) {
  if (n == 0) return std::nullopt;
  return WilsonRate(hits, n);
}

void CountRow(const std::vector<Score>& scores, const CountingRule& rule,
              Metrics& m) {
  ClusteredMean acr;
  ClusteredMean mean_gap;
  ClusteredMean mogr;
  for (const Score& score : scores) {
    if (score.repeat != 0) continue;
    const CaseCounts c = CountCase(score, rule);
    m.without_baseline += c.path ? 0 : 1;
    if (!c.path) continue;
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
    acr.Add(score, c.lower, c.reduction);
    mean_gap.Add(score, c.gap, c.gap_size);
    mogr.Add(score, c.gap, c.recovery);
  }
  m.acr = acr.Mean();
  m.mean_gap = mean_gap.Mean();
  if (rule.fallback) m.mogr = mogr.Mean();
}

void MeasureTimes(const std::vector<Score>& scores, Metrics& m) {
  std::vector<double> prep;
  std::vector<double> llm;
  std::vector<double> det;
  std::vector<double> e2e;
  double total = 0;
  for (const Score& score : scores) {
    if (score.repeat != 0 || score.kind == AttemptKind::kNoBaseline) continue;
    prep.push_back(score.t_prep);
    llm.push_back(score.t_llm);
    det.push_back(score.t_det);
    e2e.push_back(score.t_e2e());
    total += score.t_e2e();
    m.tokens_in += score.tokens_in;
    m.tokens_out += score.tokens_out;
    m.spend += score.spend;
  }
  if (e2e.empty()) return;
  const auto n = static_cast<double>(e2e.size());
  m.prep_median = Median(std::move(prep));
  m.det_median = Median(std::move(det));
  if (!std::isfinite(total)) return;  // Answers from files have no time.
  m.llm_median = Median(std::move(llm));
  m.e2e_p95 = NearestRank(e2e, 95);
  m.e2e_median = Median(std::move(e2e));
  if (total > 0) m.fps = n / total;
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

Metrics ComputeMetrics(const std::vector<Score>& scores,
                       const CountingRule& rule) {
  Metrics m;
  CountRow(scores, rule, m);
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
  MeasureTimes(scores, m);
  return m;
}

RepeatFigures ComputeRepeats(const std::vector<Score>& scores,
                             const CountingRule& rule) {
  struct Tally {
    int repeats = 0;
    int lower = 0;
  };
  std::map<std::string_view, Tally> tallies;
  for (const Score& score : scores) {
    const CaseCounts c = CountCase(score, rule);
    if (!c.path) continue;
    Tally& tally = tallies[score.case_id];
    ++tally.repeats;
    tally.lower += c.lower ? 1 : 0;
  }
  RepeatFigures figures;
  for (const auto& [id, tally] : tallies) {
    figures.repeats = std::max(figures.repeats, tally.repeats);
    figures.mean_lower += static_cast<double>(tally.lower) / tally.repeats;
    figures.unstable += tally.lower != 0 && tally.lower != tally.repeats;
  }
  if (!tallies.empty()) {
    figures.mean_lower /= static_cast<double>(tallies.size());
    figures.unstable /= static_cast<double>(tallies.size());
  }
  return figures;
}

Comparison ComparePaired(const std::vector<Score>& first,
                         const CountingRule& first_rule,
                         const std::vector<Score>& second,
                         const CountingRule& second_rule) {
  std::unordered_map<std::string_view, const Score*> of_first;
  for (const Score& score : first) {
    if (score.repeat == 0) of_first.emplace(score.case_id, &score);
  }
  Comparison result;
  ClusteredMean mogr;
  for (const Score& score : second) {
    const auto found = of_first.find(score.case_id);
    if (score.repeat != 0 || found == of_first.end()) continue;
    const CaseCounts a = CountCase(*found->second, first_rule);
    const CaseCounts b = CountCase(score, second_rule);
    if (!a.path || !b.path) continue;
    ++result.cases;
    result.only_first_lower += a.lower && !b.lower ? 1 : 0;
    result.only_second_lower += b.lower && !a.lower ? 1 : 0;
    mogr.Add(score, a.gap && b.gap, a.recovery - b.recovery);
  }
  result.mcnemar_p =
      McNemarExact(result.only_first_lower, result.only_second_lower);
  if (first_rule.fallback && second_rule.fallback) {
    result.mogr_difference = mogr.Mean();
  }
  return result;
}

}  // namespace terra::benchmark

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/case_result.h"
#include "benchmark/case_sample.h"
#include "benchmark/clustered_mean.h"
#include "benchmark/statistics.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// How a row's results are to be counted: properties of its method.
struct CountingRule {
  /// The final route is the accepted candidate, else the baseline.
  bool fallback = true;
  /// Every case is an attempt (methods without fallback, refiners, controls);
  /// else every answer but the canonical Yes (`advisor`).
  bool every_case_attempts = false;
};

/// What the metrics need of a CaseResult, without its routes.
struct Score {
  std::string case_id;
  std::string group;
  std::string cluster;  ///< RUGD: the sequence; else empty.
  std::int64_t map_id = 0;
  AttemptKind kind = AttemptKind::kNoAnswer;
  AnswerStyle form = AnswerStyle::kNone;
  bool invalid_code = false;  ///< Parse, count, end, border or obstacle.
  double baseline_cost = kImpassable;
  double oracle_cost = kImpassable;
  double final_cost = kImpassable;
  double t_prep = 0;
  double t_llm = 0;
  double t_det = 0;
  std::int64_t tokens_in = 0;
  std::int64_t tokens_out = 0;
  double spend = 0;
  int repeat = 0;
  int candidates = 0;
  int candidates_lower = 0;
  int candidates_invalid = 0;
};
Score ToScore(const CaseResult& result);

/// What one case counts as. All false for a case without a baseline, which is
/// not in N_Path. Costs are compared with epsilon = 1e-6.
struct CaseCounts {
  bool path = false;
  bool suggested = false;
  bool invalid = false;    ///< Of the suggested ones.
  bool tolerated = false;  ///< Suggested and valid, but not in exact form.
  bool no_answer = false;
  bool lower = false;
  bool final_valid = false;
  bool non_degraded = false;
  bool comparable = false;
  bool gap = false;
  double reduction = 0;  ///< (C(P_c) - C) / C(P_c) of a lower one.
  double gap_size = 0;   ///< (C(P_c) - C*) / C(P_c) of a gap.
  double recovery = 0;   ///< (C(P_c) - C) / (C(P_c) - C*) of a gap.
};
CaseCounts CountCase(const Score& score, const CountingRule& rule);

/// The paper's metrics of one row (section Evaluation Metrics and the oracle
/// analysis), made exact by the protocol. A rate of 0/0 is absent.
struct Metrics {
  std::int64_t paths = 0;
  std::int64_t without_baseline = 0;
  std::int64_t suggested = 0;
  std::int64_t invalid = 0;
  std::int64_t tolerated = 0;
  std::int64_t lower = 0;
  std::int64_t no_answer = 0;
  std::int64_t final_valid = 0;
  std::int64_t non_degraded = 0;
  std::int64_t comparable = 0;
  std::int64_t gaps = 0;
  // Of runs whose answers may have several candidates; else 0.
  std::int64_t candidates = 0;
  std::int64_t candidates_lower = 0;
  std::int64_t candidates_invalid = 0;

  std::int64_t non_improving() const { return suggested - invalid - lower; }

  std::optional<Estimate> asr, isr, vnsr, fir, validity, ndr, gap_rate;
  /// ISR with answers that are not in exact form counted as invalid.
  std::optional<Estimate> strict_isr;
  /// Lower and invalid ones over all candidates, not cases.
  std::optional<Estimate> candidate_asr, candidate_isr;
  std::optional<Estimate> acr, mean_gap;
  std::optional<Estimate> mogr;  ///< Absent for methods without fallback.

  /// Seconds; absent without cases.
  std::optional<double> prep_median, llm_median, det_median, e2e_median,
      e2e_p95, fps;
  std::int64_t tokens_in = 0;
  std::int64_t tokens_out = 0;
  double spend = 0;
};

/// What reads scores one by one, and as often as it is asked: from a file, in
/// the order of its rows, or of a list.
using ScoreReader =
    std::function<Status(const std::function<void(const Score&)>&)>;
ScoreReader ReaderOf(std::vector<Score> scores);

/// Gathers the metrics of one row of a table, a case at a time. Counts, rates
/// and means are of all cases; times and the intervals of means are of a
/// sample, of each case of which 48 bytes are kept (three times, three terms of
/// means), 56 while they are worked out.
class MetricsBuilder {
 public:
  explicit MetricsBuilder(const CountingRule& rule, CasePart sample = {})
      : rule_(rule), sample_(sample) {}

  /// Other repeats than 0 are left out.
  void Add(const Score& score);

  /// The metrics of what was added; once.
  Metrics Finish();

 private:
  void MeasureTimes();

  CountingRule rule_;
  CasePart sample_;
  Metrics metrics_;
  ClusteredMean acr_;
  ClusteredMean mean_gap_;
  ClusteredMean mogr_;
  std::vector<double> t_prep_;
  std::vector<double> t_llm_;
  std::vector<double> t_det_;
};

Metrics ComputeMetrics(const std::vector<Score>& scores,
                       const CountingRule& rule);

/// Answer variability over repeats: mean over the cases of the share of repeats
/// that were lower, and the share of cases whose repeats differ in that. Of a
/// sample of the cases; some 100 bytes of each are kept.
struct RepeatFigures {
  int repeats = 0;
  double mean_lower = 0;
  double unstable = 0;
};
class RepeatsBuilder {
 public:
  explicit RepeatsBuilder(const CountingRule& rule, CasePart sample = {})
      : rule_(rule), sample_(sample) {}

  void Add(const Score& score);
  RepeatFigures Figures() const;

 private:
  struct Tally {
    int repeats = 0;
    int lower = 0;
  };

  CountingRule rule_;
  CasePart sample_;
  std::map<std::string, Tally> tallies_;
};

}  // namespace terra::benchmark

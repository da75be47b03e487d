#include "benchmark/comparison.h"

#include <string>
#include <unordered_map>

#include "benchmark/clustered_mean.h"

namespace terra::benchmark {
namespace {

// What a comparison needs of a case.
struct Outcome {
  double recovery = 0;
  bool lower = false;
  bool gap = false;
};
using Outcomes = std::unordered_map<std::string, Outcome>;

Result<Outcomes> ReadOutcomes(const ScoreReader& reader,
                              const CountingRule& rule) {
  Outcomes outcomes;
  const Status read = reader([&](const Score& score) {
    const CaseCounts c = CountCase(score, rule);
    if (score.repeat != 0 || !c.path) return;
    outcomes.emplace(score.case_id, Outcome{c.recovery, c.lower, c.gap});
  });
  if (!read.ok()) return read.error();
  return outcomes;
}

}  // namespace

Result<Comparison> ComparePaired(const ScoreReader& first,
                                 const CountingRule& first_rule,
                                 const ScoreReader& second,
                                 const CountingRule& second_rule) {
  const Result<Outcomes> of_first = ReadOutcomes(first, first_rule);
  if (!of_first.ok()) return of_first.error();
  Comparison result;
  ClusteredMean mogr;
  const Status read = second([&](const Score& score) {
    const auto found = of_first->find(score.case_id);
    if (score.repeat != 0 || found == of_first->end()) return;
    const Outcome& a = found->second;
    const CaseCounts b = CountCase(score, second_rule);
    if (!b.path) return;
    ++result.cases;
    result.only_first_lower += a.lower && !b.lower ? 1 : 0;
    result.only_second_lower += b.lower && !a.lower ? 1 : 0;
    mogr.Add(score.cluster, a.gap && b.gap, a.recovery - b.recovery);
  });
  if (!read.ok()) return read.error();
  result.mcnemar_p =
      McNemarExact(result.only_first_lower, result.only_second_lower);
  if (first_rule.fallback && second_rule.fallback) {
    result.mogr_difference = mogr.Mean();
  }
  return result;
}

}  // namespace terra::benchmark

#include "benchmark/comparison.h"

#include <algorithm>
#include <vector>

#include "benchmark/clustered_mean.h"

namespace terra::benchmark {
namespace {

// What a comparison needs of a case.
struct Outcome {
  std::uint64_t key = 0;
  double recovery = 0;
  bool lower = false;
  bool gap = false;
};

bool KeyIsLess(const Outcome& outcome, std::uint64_t key) {
  return outcome.key < key;
}

// In order of their keys.
Result<std::vector<Outcome>> ReadOutcomes(const ScoreReader& reader,
                                          const CountingRule& rule) {
  std::vector<Outcome> outcomes;
  const Status read = reader([&](const Score& score) {
    const CaseCounts c = CountCase(score, rule);
    if (score.repeat != 0 || !c.path) return;
    outcomes.push_back({CaseKey(score.case_id), c.recovery, c.lower, c.gap});
  });
  if (!read.ok()) return read.error();
  std::sort(outcomes.begin(), outcomes.end(),
            [](const Outcome& a, const Outcome& b) {
              return a.key < b.key;
            });
  return outcomes;
}

}  // namespace

Result<Comparison> ComparePaired(const ScoreReader& first,
                                 const CountingRule& first_rule,
                                 const ScoreReader& second,
                                 const CountingRule& second_rule) {
  const Result<std::vector<Outcome>> of_first = ReadOutcomes(first, first_rule);
  if (!of_first.ok()) return of_first.error();
  Comparison result;
  ClusteredMean mogr;
  const Status read = second([&](const Score& score) {
    const std::uint64_t key = CaseKey(score.case_id);
    const auto found =
        std::lower_bound(of_first->begin(), of_first->end(), key, KeyIsLess);
    const bool both = found != of_first->end() && found->key == key;
    if (score.repeat != 0 || !both) return;
    const Outcome& a = *found;
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

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

// Those of a part, in order of their keys.
Result<std::vector<Outcome>> ReadOutcomes(const ScoreReader& reader,
                                          const CountingRule& rule,
                                          CasePart part) {
  std::vector<Outcome> outcomes;
  const Status read = reader([&](const Score& score) {
    const std::uint64_t key = CaseKey(score.case_id);
    if (!part.Takes(key)) return;
    const CaseCounts c = CountCase(score, rule);
    if (score.repeat != 0 || !c.path) return;
    outcomes.push_back({key, c.recovery, c.lower, c.gap});
  });
  if (!read.ok()) return read.error();
  std::sort(outcomes.begin(), outcomes.end(),
            [](const Outcome& a, const Outcome& b) {
              return a.key < b.key;
            });
  return outcomes;
}

// One of the two methods.
struct Side {
  const ScoreReader& reader;
  const CountingRule& rule;
};

// Adds the cases of a part that both have.
Status ComparePart(const Side& first, const Side& second, CasePart part,
                   Comparison& result, ClusteredMean& mogr) {
  const auto of_first = ReadOutcomes(first.reader, first.rule, part);
  if (!of_first.ok()) return of_first.error();
  return second.reader([&](const Score& score) {
    const std::uint64_t key = CaseKey(score.case_id);
    if (score.repeat != 0 || !part.Takes(key)) return;
    const auto a =
        std::lower_bound(of_first->begin(), of_first->end(), key, KeyIsLess);
    if (a == of_first->end() || a->key != key) return;
    const CaseCounts b = CountCase(score, second.rule);
    if (!b.path) return;
    ++result.cases;
    result.only_first_lower += a->lower && !b.lower ? 1 : 0;
    result.only_second_lower += b.lower && !a->lower ? 1 : 0;
    mogr.Add(score.cluster, a->gap && b.gap, a->recovery - b.recovery,
             part.index == 0);
  });
}

}  // namespace

Result<Comparison> ComparePaired(const ScoreReader& first,
                                 const CountingRule& first_rule,
                                 const ScoreReader& second,
                                 const CountingRule& second_rule,
                                 std::int64_t cases, std::int64_t at_once) {
  Comparison result;
  ClusteredMean mogr;
  const std::uint64_t parts = NumParts(cases, at_once);
  for (CasePart part{0, parts}; part.index < parts; ++part.index) {
    const Status compared = ComparePart(
        {first, first_rule}, {second, second_rule}, part, result, mogr);
    if (!compared.ok()) return compared.error();
  }
  result.mcnemar_p =
      McNemarExact(result.only_first_lower, result.only_second_lower);
  if (first_rule.fallback && second_rule.fallback) {
    result.mogr_difference = mogr.Mean();
  }
  return result;
}

}  // namespace terra::benchmark

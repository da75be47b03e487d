// 64 answers that a real model gave (tests/data/llm-answers): read and verified
// here they give the rows that another program computed.
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "advisor/answer_parser.h"
#include "advisor/polish.h"
#include "planner/coarse_lattice.h"
#include "terrain/files/dataset.h"
#include "terrain/files/whole_file.h"
#include "terrain/native_search.h"
#include "verifier/verify.h"

namespace terra::advisor {
namespace {

constexpr double kEpsilon = 1e-6;

// A case with its baseline and what was answered, in the two prompts.
struct Recorded {
  TerrainMap map;
  Cell start;
  Cell goal;
  Route baseline;
  double baseline_cost = 0;
  double oracle_cost = 0;
  Answer native;
  Answer axes;
};

Answer ReadAnswer(const std::string& form, const std::string& case_id) {
  AnswerRules rules;
  rules.max_candidates = form == "axes" ? 3 : 1;
  return ParseAnswer(ReadWholeFile(TERRA_TEST_DATA "/llm-answers/answers/" +
                                       form + "/" + case_id + ".txt",
                                   1u << 16)
                         .value(),
                     rules);
}

const std::vector<Recorded>& Cases() {
  static const auto* const cases = [] {
    auto* const read = new std::vector<Recorded>;
    const Dataset dataset = ReadDataset(TERRA_TEST_DATA "/llm-answers").value();
    for (const DatasetCase& c : dataset.cases) {
      TerrainMap map = ReadCaseMap(dataset, c).value();
      planner::LatticePlan plan = planner::PlanOnLattice(map, c.start, c.goal);
      const double oracle = NativeSearch(map, c.start, c.goal).cost;
      read->push_back({std::move(map), c.start, c.goal,
                       std::move(plan.waypoints), plan.cost, oracle,
                       ReadAnswer("native", c.case_id),
                       ReadAnswer("axes", c.case_id)});
    }
    return read;
  }();
  return *cases;
}

struct Row {
  double fir = 0;        // Made cheaper, of all cases.
  double asr = 0;        // Made cheaper, of the attempts.
  double isr = 0;        // Invalid, of the attempts.
  double acr = 0;        // Mean saving where made cheaper.
  double recovered = 0;  // Mean share of the gap, where there is one.
};

// The cost an attempt comes to, kImpassable when invalid; none for a retention.
using Attempt = std::function<std::optional<double>(const Recorded&)>;

Row Score(const Attempt& attempt) {
  int attempts = 0;
  int cheaper = 0;
  int invalid = 0;
  int with_gap = 0;
  Row row;
  for (const Recorded& c : Cases()) {
    const std::optional<double> cost = attempt(c);
    attempts += cost ? 1 : 0;
    invalid += cost == kImpassable ? 1 : 0;
    const double saving = cost ? std::max(0.0, c.baseline_cost - *cost) : 0.0;
    if (saving > kEpsilon) {
      ++cheaper;
      row.acr += 100 * saving / c.baseline_cost;
    }
    if (c.oracle_cost < c.baseline_cost - kEpsilon) {
      ++with_gap;
      row.recovered += 100 * saving / (c.baseline_cost - c.oracle_cost);
    }
  }
  row.fir = 100.0 * cheaper / static_cast<double>(Cases().size());
  row.asr = 100.0 * cheaper / attempts;
  row.isr = 100.0 * invalid / attempts;
  row.acr /= cheaper;
  row.recovered /= with_gap;
  return row;
}

void ExpectRow(const Row& got, const Row& want) {
  constexpr double kPrinted = 0.00501;  // Two decimals.
  EXPECT_NEAR(got.fir, want.fir, kPrinted);
  EXPECT_NEAR(got.asr, want.asr, kPrinted);
  EXPECT_NEAR(got.isr, want.isr, kPrinted);
  EXPECT_NEAR(got.acr, want.acr, kPrinted);
  EXPECT_NEAR(got.recovered, want.recovered, kPrinted);
}

double Verified(const Recorded& c, const AnswerCandidate& candidate) {
  return verifier::CheckRoute(c.map, candidate.waypoints, c.start, c.goal).cost;
}

std::optional<double> First(const Recorded& c, const Answer& answer) {
  if (answer.kind == AnswerKind::kRetain) return std::nullopt;
  if (answer.candidates.empty()) return kImpassable;
  return Verified(c, answer.candidates.front());
}

std::optional<double> FirstPolished(const Recorded& c, const Answer& answer) {
  if (answer.kind == AnswerKind::kRetain) return std::nullopt;
  if (answer.candidates.empty()) return kImpassable;
  return Polish({c.map, c.baseline, c.baseline_cost},
                answer.candidates.front().waypoints)
      .cost;
}

TEST(RecordedAnswersTest, NativeAnswersScoreAsRecorded) {
  ExpectRow(Score([](const Recorded& c) {
              return First(c, c.native);
            }),
            {84.38, 96.43, 0, 11.89, 83.74});
}

TEST(RecordedAnswersTest, FirstAxesAnswersScoreAsRecorded) {
  ExpectRow(Score([](const Recorded& c) {
              return First(c, c.axes);
            }),
            {87.50, 100, 0, 12.10, 86.08});
}

TEST(RecordedAnswersTest, BestOfTheAxesAnswersScoresAsRecorded) {
  ExpectRow(Score([](const Recorded& c) {
              std::optional<double> best = First(c, c.axes);
              for (const AnswerCandidate& candidate : c.axes.candidates) {
                best = std::min(best.value_or(kImpassable),
                                Verified(c, candidate));
              }
              return best;
            }),
            {87.50, 100, 0, 12.46, 90.30});
}

TEST(RecordedAnswersTest, PolishedAnswersScoreAsRecorded) {
  ExpectRow(Score([](const Recorded& c) {
              return FirstPolished(c, c.native);
            }),
            {87.50, 100, 0, 13.06, 99.15});
  ExpectRow(Score([](const Recorded& c) {
              return FirstPolished(c, c.axes);
            }),
            {87.50, 100, 0, 13.40, 100});
}

TEST(RecordedAnswersTest, AllAnswersHaveTheFormAskedFor) {
  for (const Recorded& c : Cases()) {
    EXPECT_NE(c.native.kind, AnswerKind::kMalformed);
    EXPECT_NE(c.axes.kind, AnswerKind::kMalformed);
    EXPECT_LE(c.native.candidates.size(), 1u);
    EXPECT_LE(c.axes.candidates.size(), 3u);
  }
}

}  // namespace
}  // namespace terra::advisor

#include "benchmark/method.h"
#include "verifier/verify.h"

namespace terra::benchmark {
namespace {

using verifier::Code;
using verifier::Comparison;

// The cheapest candidate that is accepted, else the first one: one case is one
// attempt, however many candidates it has.
void JudgeCandidates(const MethodInput& input, const Attempt& attempt,
                     CaseResult& result) {
  for (const Route& route : attempt.candidates) {
    const Comparison judged = verifier::CompareRoutes(
        input.map, input.dataset_case.start, input.dataset_case.goal,
        input.baseline.waypoints, route);
    ++result.candidates;
    result.candidates_lower += judged.accepted() ? 1 : 0;
    result.candidates_invalid += IsInvalidCode(judged.code) ? 1 : 0;
    const bool better =
        judged.accepted() && (result.code != Code::kAccepted ||
                              judged.candidate.cost < result.candidate_cost);
    if (result.code != Code::kNotChecked && !better) continue;
    result.code = judged.code;
    result.candidate_cost = judged.candidate.cost;
    result.candidate_route = route;
  }
}

// With fallback the accepted candidate or the baseline; without it whatever the
// method returned, valid or not.
void DecideFinal(const MethodInput& input, const MethodInfo& info,
                 CaseResult& result) {
  const bool candidate_is_final = info.rule.fallback
                                      ? result.code == Code::kAccepted
                                      : result.kind != AttemptKind::kRetain;
  if (candidate_is_final) {
    result.final_route = result.candidate_route;
    result.final_cost = result.candidate_cost;
  } else {
    result.final_route = input.baseline.waypoints;
    result.final_cost = input.baseline.cost;
  }
}

}  // namespace

CaseResult ScoreAttempt(const MethodInput& input, const MethodInfo& info,
                        double oracle_cost, const Attempt& attempt) {
  CaseResult result;
  result.case_id = input.dataset_case.case_id;
  result.group = input.dataset_case.group;
  const auto sequence = input.dataset_case.extra.find("sequence");
  if (sequence != input.dataset_case.extra.end()) {
    result.sequence = sequence->second;
  }
  result.map_id = input.map_id;
  result.repeat = input.repeat;
  result.kind = attempt.kind;
  result.form = attempt.form;
  result.baseline_cost = input.baseline.cost;
  result.oracle_cost = oracle_cost;
  switch (attempt.kind) {
    case AttemptKind::kPropose:
      JudgeCandidates(input, attempt, result);
      break;
    case AttemptKind::kRetain:
      result.code = Code::kRetained;
      break;
    case AttemptKind::kMalformed:
      result.code = Code::kParseError;
      break;
    case AttemptKind::kNoAnswer:
    case AttemptKind::kNoBaseline:
      break;
  }
  DecideFinal(input, info, result);
  result.t_prep = attempt.t_prep;
  result.t_llm = attempt.t_llm;
  result.t_det = attempt.t_det;
  result.tries = attempt.tries;
  result.tokens_in = attempt.tokens_in;
  result.tokens_out = attempt.tokens_out;
  result.spend = attempt.spend;
  result.request_hash = attempt.request_hash;
  return result;
}

}  // namespace terra::benchmark

#pragma once

#include <stop_token>
#include <string>

#include "advisor/llm_client.h"
#include "advisor/llm_methods.h"

namespace terra::advisor {

/// A case's answer and what it took to get it.
struct AskedCase {
  /// The reply that counts; tries, time, tokens and spend are those of all
  /// rounds together.
  LlmReply reply;
  MethodOutcome outcome;
  std::string request_hash;  ///< Of the question that the reply answers.
  int rounds = 0;
};

/// What a program that verifies a proposal would say of it, for the model that
/// made it. Empty when it is a feasible route from start to goal and, for
/// `advisor`, cheaper than the baseline. No cost of a baseline that the
/// question does not tell is told here.
std::string VerdictForModel(const PlanningCase& planning_case,
                            const MethodOptions& options,
                            const OutcomeCandidate& candidate);

/// Asks, and as long as rounds and time are left asks again with the verdict
/// when no candidate of a proposal is any good. Answers that are no route
/// (malformed, refused, truncated), retentions and failures end it: they are
/// never asked again. When a later round brings no answer the one before
/// counts.
///
/// `options.rounds` of 1, the paper's, asks once. No round begins that would
/// pass `options.rounds_deadline_s` if it took as long as the one before.
AskedCase AskInRounds(const PlanningCase& planning_case,
                      const MethodOptions& options, LlmRequest request,
                      LlmClient& client, std::stop_token stop);

}  // namespace terra::advisor

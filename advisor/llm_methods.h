#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "advisor/answer_parser.h"
#include "advisor/llm_client.h"
#include "advisor/prompt.h"
#include "advisor/reference_pool.h"
#include "terrain/cell.h"
#include "terrain/map.h"

namespace terra::advisor {

/// What a method works on: a valid baseline on the clean map.
struct PlanningCase {
  std::string case_id;  ///< On the bus: map_id, start, goal.
  const TerrainMap& map;
  Cell start;
  Cell goal;
  const Route& baseline;     ///< Feasible; its ends are start and goal.
  double baseline_cost = 0;  ///< Equals WalkRoute(map, baseline).cost.
  /// RUGD: references of this sequence are excluded. Else empty.
  std::string sequence;
};

/// How an LLM method is run. The defaults are the paper's.
struct MethodOptions {
  Method method = Method::kAdvisor;
  PromptSwitches prompt;
  double noise_percent = 0;  ///< Of the LLM-facing map only; 0 to 100.
  std::uint64_t seed = 0;    ///< Of noise and of the choice of references.
  /// How often a case may be asked, the verdict on a rejected proposal fed
  /// back, and within which time. See AskInRounds.
  int rounds = 1;
  double rounds_deadline_s = 900;
};

/// A case turned into a question.
struct PreparedCase {
  LlmRequest request;
  /// The pair shown: its map_id; empty when none was.
  std::string reference_id;
  /// REA was asked for, but the pool has no pair that may be shown.
  bool reference_missing = false;
};

/// Draws the pictures and writes the text. Pure and deterministic; its time is
/// T_prep. `pool` may be null (no REA).
PreparedCase PrepareCase(const PlanningCase& planning_case,
                         const MethodOptions& options,
                         const ReferencePool* pool);

/// One proposed route.
struct OutcomeCandidate {
  /// Waypoints as answered (`advisor`, `direct`), or the cells of the joined
  /// legs (`llm-astar`). Empty when it has a fault.
  Route route;
  /// Empty when the route can be verified, else why not: an AnswerFault's name,
  /// or `target_outside`, `target_blocked`, `target_unreachable` (llm-astar).
  std::string fault;
};

/// What a method's answer comes to, before verification: kFailed when nothing
/// came (see reply.reason), kRetain for `advisor` alone.
struct MethodOutcome {
  AnswerKind kind = AnswerKind::kFailed;
  AnswerForm form = AnswerForm::kNone;  ///< Of what kRetain and kPropose read.
  /// Why, for kFailed and kMalformed, in a word ("refused", "empty",
  /// "not_an_integer", "deadline"); empty otherwise.
  std::string cause;
  std::string detail;  ///< The same for people, with the position.
  /// In the order answered; at most as many as asked for. kPropose only; then
  /// at least one.
  std::vector<OutcomeCandidate> candidates;
};

/// Reads a reply by the rules of the method; joins the targets of `llm-astar`
/// leg by leg with the native search. Pure; its time is part of T_det.
MethodOutcome ReadReply(const PlanningCase& planning_case,
                        const MethodOptions& options, const LlmReply& reply);

}  // namespace terra::advisor

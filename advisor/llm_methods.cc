#include "advisor/llm_methods.h"

#include <optional>
#include <utility>

#include "advisor/map_noise.h"
#include "advisor/pictures.h"
#include "terrain/digest.h"
#include "terrain/native_search.h"

namespace terra::advisor {
namespace {

std::shared_ptr<const EncodedPicture> Encoded(const Picture& picture) {
  return std::make_shared<const EncodedPicture>(EncodePicture(picture));
}

/// The pair to show, when the method and the switches want one.
const ReferencePair* ChooseReference(const PlanningCase& in,
                                     const MethodOptions& options,
                                     const ReferencePool* pool) {
  if (pool == nullptr) {
    return nullptr;
  }
  return pool->Choose(options.seed, in.case_id, in.map.legend(),
                      {MapId(in.map), in.sequence});
}

MethodOutcome Malformed(std::string cause, std::string detail) {
  MethodOutcome outcome;
  outcome.kind = AnswerKind::kMalformed;
  outcome.cause = std::move(cause);
  outcome.detail = std::move(detail);
  return outcome;
}

std::string AtPosition(AnswerFault fault, std::size_t position) {
  return std::string(FaultName(fault)) + " at byte " +
         std::to_string(position) + " of the answer";
}

/// What is wrong with an answer, and what is known of how it came to be so.
std::string FaultDetail(AnswerFault fault, std::size_t position,
                        const std::string& note) {
  if (note.empty()) return AtPosition(fault, position);
  return fault == AnswerFault::kEmpty
             ? note
             : AtPosition(fault, position) + "; " + note;
}

/// Does a list of targets name anything besides start and goal?
bool HasTarget(const Route& targets, Cell start, Cell goal) {
  for (const Cell cell : targets) {
    if (cell != start && cell != goal) return true;
  }
  return false;
}

/// Joins start, targets and goal, each to the next, at the lowest cost.
OutcomeCandidate JoinTargets(const PlanningCase& in, const Route& targets) {
  OutcomeCandidate joined;
  Route stops = {in.start};
  stops.insert(stops.end(), targets.begin(), targets.end());
  stops.push_back(in.goal);
  for (const Cell cell : stops) {
    if (!in.map.Contains(cell)) return {{}, "target_outside"};
    if (!in.map.Passable(cell)) return {{}, "target_blocked"};
  }
  joined.route = {in.start};
  for (std::size_t i = 1; i < stops.size(); ++i) {
    if (stops[i] == stops[i - 1]) continue;
    const SearchResult leg = NativeSearch(in.map, stops[i - 1], stops[i]);
    if (!leg.found()) return {{}, "target_unreachable"};
    joined.route.insert(joined.route.end(), leg.cells.begin() + 1,
                        leg.cells.end());
  }
  if (joined.route.size() == 1) joined.route.push_back(in.goal);
  return joined;
}

OutcomeCandidate ReadCandidate(const PlanningCase& in, Method method,
                               const AnswerCandidate& candidate) {
  if (candidate.fault != AnswerFault::kNone) {
    return {{}, std::string(FaultName(candidate.fault))};
  }
  if (method != Method::kLlmAstar) {
    return {candidate.waypoints, ""};
  }
  if (!HasTarget(candidate.waypoints, in.start, in.goal)) {
    return {{}, "no_target"};
  }
  return JoinTargets(in, candidate.waypoints);
}

}  // namespace

PreparedCase PrepareCase(const PlanningCase& in, const MethodOptions& options,
                         const ReferencePool* pool) {
  PreparedCase prepared;
  const bool advisor = options.method == Method::kAdvisor;
  std::optional<TerrainMap> noisy;
  if (options.noise_percent > 0) {
    noisy = WithNoise(in.map, {options.noise_percent, options.seed, in.case_id,
                               in.start, in.goal});
  }
  const TerrainMap& shown = noisy ? *noisy : in.map;
  const PictureFrame frame =
      ChooseFrame(shown.width(), shown.height(), options.prompt.axes);
  PromptInput text{.method = options.method,
                   .switches = options.prompt,
                   .shown = shown,
                   .start = in.start,
                   .goal = in.goal,
                   .clean = in.map,
                   .baseline = in.baseline,
                   .baseline_cost = in.baseline_cost,
                   .frame = frame,
                   .reference = std::nullopt};

  LlmRequest& request = prepared.request;
  request.pictures.push_back(Encoded(DrawMap(shown, frame, in.start, in.goal)));
  if (advisor && options.prompt.overlay) {
    request.pictures.push_back(
        Encoded(DrawMap(shown, frame, in.start, in.goal, &in.baseline)));
  }
  if (advisor && options.prompt.rea) {
    if (const ReferencePair* pair = ChooseReference(in, options, pool)) {
      request.pictures.push_back(pool->PictureOf(*pair));
      text.reference = pair->costs;
      prepared.reference_id = std::to_string(pair->map_id);
    } else {
      prepared.reference_missing = true;
    }
  }
  request.text = WritePrompt(text);
  request.method = MethodName(options.method);
  request.prompt_id = PromptId();
  request.case_id = in.case_id;
  return prepared;
}

MethodOutcome ReadReply(const PlanningCase& in, const MethodOptions& options,
                        const LlmReply& reply) {
  switch (reply.status) {
    case ReplyStatus::kNoAnswer: {
      MethodOutcome none;
      none.cause = NoAnswerName(reply.reason);
      none.detail = reply.error;
      return none;
    }
    case ReplyStatus::kTruncated:
      return Malformed("truncated", "cut by the limit of output tokens");
    case ReplyStatus::kRefused:
      return Malformed("refused", reply.error);
    case ReplyStatus::kAnswered:
      break;
  }
  AnswerRules rules;
  rules.style = options.method == Method::kAdvisor ? AnswerStyle::kAdvice
                                                   : AnswerStyle::kRoute;
  rules.max_candidates = options.prompt.candidates;
  const Answer answer = ParseAnswer(reply.text, rules);
  if (answer.kind == AnswerKind::kMalformed) {
    return Malformed(std::string(FaultName(answer.fault)),
                     FaultDetail(answer.fault, answer.position, reply.error));
  }
  MethodOutcome outcome;
  outcome.form = answer.form;
  outcome.kind = answer.kind;
  for (const AnswerCandidate& candidate : answer.candidates) {
    outcome.candidates.push_back(ReadCandidate(in, options.method, candidate));
  }
  if (!outcome.candidates.empty() &&
      outcome.candidates.front().fault == "no_target") {
    return Malformed("no_target",
                     "the answer names no target besides start and goal");
  }
  return outcome;
}

}  // namespace terra::advisor

#include "advisor/llm_rounds.h"

#include <utility>

#include "advisor/descriptions.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"

namespace terra::advisor {
namespace {

constexpr double kEpsilon = 1e-6;  // Of the gate: what is strictly cheaper.

std::string FaultText(const Route& route, const RouteWalk& walk) {
  const char* what = walk.fault == RouteFault::kOutOfBounds
                         ? "leaves the map at "
                         : "enters an obstacle at ";
  std::string text = what + ToString(walk.cell);
  const auto segment = static_cast<std::size_t>(walk.segment);
  if (walk.segment >= 0 && segment + 1 < route.size()) {
    text += ", between " + ToString(route[segment]) + " and " +
            ToString(route[segment + 1]);
  }
  return text + ".";
}

std::string CostVerdict(const PlanningCase& in, const MethodOptions& options,
                        double cost) {
  if (options.method != Method::kAdvisor ||
      cost < in.baseline_cost - kEpsilon) {
    return "";
  }
  std::string text =
      "costs " + TotalText(cost) + ", not less than the baseline";
  if (options.prompt.route_text) {
    text += ", which costs " + TotalText(in.baseline_cost);
  }
  return text + ".";
}

/// The verdict on the first candidate; empty when any of them is good.
std::string VerdictOn(const PlanningCase& in, const MethodOptions& options,
                      const MethodOutcome& outcome) {
  std::string first;
  for (const OutcomeCandidate& candidate : outcome.candidates) {
    std::string verdict = VerdictForModel(in, options, candidate);
    if (verdict.empty()) return "";
    if (first.empty()) first = std::move(verdict);
  }
  return first;
}

std::string AgainText(const std::string& answer, const std::string& verdict) {
  constexpr std::size_t kMostQuoted = 4'096;
  return "\nYOUR EARLIER ANSWER\n" + answer.substr(0, kMostQuoted) +
         "\nIt was checked and rejected: the route " + verdict +
         "\nAnswer again, in the form above.\n";
}

/// Adds what earlier rounds took to a reply.
void AddCosts(const LlmReply& before, LlmReply& reply) {
  reply.tries += before.tries;
  reply.t_llm_s += before.t_llm_s;
  reply.usage.tokens_in += before.usage.tokens_in;
  reply.usage.tokens_out += before.usage.tokens_out;
  reply.usage.tokens_thinking += before.usage.tokens_thinking;
  if (before.spend_usd) {
    reply.spend_usd = reply.spend_usd.value_or(0) + *before.spend_usd;
  }
}

}  // namespace

std::string VerdictForModel(const PlanningCase& in,
                            const MethodOptions& options,
                            const OutcomeCandidate& candidate) {
  if (!candidate.fault.empty()) {
    return "could not be used (" + candidate.fault + ").";
  }
  const Route& route = candidate.route;
  if (route.size() < 2) return "has fewer than two waypoints.";
  if (route.front() != in.start) {
    return "begins at " + ToString(route.front()) + ", not at the start " +
           ToString(in.start) + ".";
  }
  if (route.back() != in.goal) {
    return "ends at " + ToString(route.back()) + ", not at the goal " +
           ToString(in.goal) + ".";
  }
  const RouteWalk walk = WalkRoute(in.map, route);
  if (!walk.feasible()) return FaultText(route, walk);
  return CostVerdict(in, options, walk.cost);
}

AskedCase AskInRounds(const PlanningCase& in, const MethodOptions& options,
                      LlmRequest request, LlmClient& client,
                      std::stop_token stop) {
  const std::string question = request.text;
  AskedCase asked;
  double last_round_s = 0;
  for (int round = 1;; ++round) {
    LlmReply reply = client.Ask(request, stop);
    last_round_s = reply.t_llm_s;
    if (round > 1) {
      if (!reply.came()) {
        AddCosts(reply, asked.reply);
        return asked;
      }
      AddCosts(asked.reply, reply);
    }
    asked.outcome = ReadReply(in, options, reply);
    asked.reply = std::move(reply);
    asked.request_hash = RequestHash(client.identity(), request);
    asked.rounds = round;
    if (round >= options.rounds || asked.outcome.kind != AnswerKind::kPropose ||
        asked.reply.t_llm_s + last_round_s > options.rounds_deadline_s) {
      return asked;
    }
    const std::string verdict = VerdictOn(in, options, asked.outcome);
    if (verdict.empty()) return asked;
    request.text = question + AgainText(asked.reply.text, verdict);
  }
}

}  // namespace terra::advisor

#include "benchmark/llm_method.h"

#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "advisor/answer_parser.h"
#include "advisor/llm_methods.h"
#include "advisor/llm_rounds.h"
#include "advisor/polish.h"
#include "advisor/prompt.h"
#include "benchmark/single_search.h"
#include "benchmark/stopwatch.h"

namespace terra::benchmark {
namespace {

using advisor::AnswerForm;
using advisor::AnswerKind;
using advisor::MethodOptions;
using advisor::PlanningCase;
using Pool = std::shared_ptr<const advisor::ReferencePool>;

AttemptKind KindOf(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::kRetain:
      return AttemptKind::kRetain;
    case AnswerKind::kPropose:
      return AttemptKind::kPropose;
    case AnswerKind::kMalformed:
      return AttemptKind::kMalformed;
    case AnswerKind::kFailed:
      break;
  }
  return AttemptKind::kNoAnswer;
}

AnswerStyle StyleOf(AnswerForm form) {
  switch (form) {
    case AnswerForm::kExact:
      return AnswerStyle::kExact;
    case AnswerForm::kTolerated:
      return AnswerStyle::kTolerated;
    case AnswerForm::kNone:
      break;
  }
  return AnswerStyle::kNone;
}

void KeepReply(const advisor::LlmReply& reply, Attempt& attempt) {
  attempt.t_llm = reply.timed ? reply.t_llm_s : kImpassable;
  attempt.tries = reply.tries;
  attempt.tokens_in = reply.usage.tokens_in;
  attempt.tokens_out = reply.usage.tokens_out;
  // Without a price the spend is not known, which is not nothing; likewise the
  // time of answers from files.
  attempt.spend = reply.spend_usd.value_or(kImpassable);
  attempt.model = reply.model;
  attempt.recorded_at = reply.recorded_at;
}

class LlmMethod : public Method {
 public:
  LlmMethod(advisor::LlmService service, const MethodOptions& options,
            Pool pool, const LlmMethodForm& form)
      : service_(std::move(service)),
        options_(options),
        pool_(std::move(pool)),
        form_(form) {}

  Attempt Try(const MethodInput& input) override {
    const PlanningCase planning_case =
        PlanningCaseOf(input.dataset_case, input.map, input.baseline);
    Attempt attempt;
    const Stopwatch prepare;
    advisor::PreparedCase prepared =
        advisor::PrepareCase(planning_case, options_, pool_.get());
    attempt.t_prep = prepare.Seconds();
    prepared.request.repeat = input.repeat;
    const advisor::AskedCase asked = advisor::AskInRounds(
        planning_case, options_, prepared.request, *service_.client, {});
    attempt.request_hash = asked.request_hash;
    KeepReply(asked.reply, attempt);
    // Read once more, to be timed: T_det has the parsing and the native legs.
    const Stopwatch read;
    Read(planning_case, input, asked.reply, attempt);
    attempt.t_det = read.Seconds();
    return attempt;
  }

 private:
  void Read(const PlanningCase& planning_case, const MethodInput& input,
            const advisor::LlmReply& reply, Attempt& attempt) const {
    const advisor::MethodOutcome outcome =
        advisor::ReadReply(planning_case, options_, reply);
    attempt.kind = KindOf(outcome.kind);
    attempt.form = StyleOf(outcome.form);
    if (form_.single_search && attempt.kind == AttemptKind::kPropose) {
      attempt.candidates.push_back(SearchOnce(planning_case, reply));
      return;
    }
    for (const advisor::OutcomeCandidate& candidate : outcome.candidates) {
      // A candidate that could not be read has no route: too few waypoints.
      Route route = candidate.route;
      if (form_.polish && !route.empty()) {
        route = advisor::Polish(
                    {input.map, input.baseline.waypoints, input.baseline.cost},
                    route)
                    .route;
      }
      attempt.candidates.push_back(std::move(route));
    }
  }

  // Meng's form forgives targets that cannot be reached, so it takes them as
  // they were answered.
  static Route SearchOnce(const PlanningCase& planning_case,
                          const advisor::LlmReply& reply) {
    advisor::AnswerRules rules;
    rules.style = advisor::AnswerStyle::kRoute;
    const advisor::Answer answer = advisor::ParseAnswer(reply.text, rules);
    if (answer.candidates.empty()) return {};
    return SingleTargetedSearch(planning_case.map, planning_case.start,
                                planning_case.goal,
                                answer.candidates.front().waypoints);
  }

  advisor::LlmService service_;
  MethodOptions options_;
  Pool pool_;
  LlmMethodForm form_;
};

std::string TitleOf(advisor::Method method, bool single_search) {
  switch (method) {
    case advisor::Method::kAdvisor:
      return "LLM-Advisor";
    case advisor::Method::kDirect:
      return "Direct LLM";
    case advisor::Method::kLlmAstar:
      return single_search ? "LLM-A* (original single search)"
                           : "LLM-A* (leg by leg)";
  }
  return "";
}

MethodInfo InfoOf(const advisor::LlmBackendOptions& options,
                  const advisor::LlmIdentity& identity,
                  const LlmMethodForm& form) {
  const bool advisor = options.method.method == advisor::Method::kAdvisor;
  MethodInfo info;
  info.method = std::string(advisor::MethodName(options.method.method)) +
                (form.single_search ? "-single" : "");
  info.backend = options.service.backend;
  info.title = TitleOf(options.method.method, form.single_search);
  info.rule = {.fallback = advisor || form.gate,
               .every_case_attempts = !advisor};
  info.uses_baseline = info.rule.fallback;
  info.asks_model = true;
  info.several_candidates = options.method.prompt.candidates > 1;
  info.simulated = identity.endpoint_class == "loopback";
  return info;
}

std::string SettingsJson(const MethodOptions& options,
                         const advisor::LlmIdentity& identity, const Pool& pool,
                         bool polish) {
  const advisor::PromptSwitches& prompt = options.prompt;
  const nlohmann::ordered_json json = {
      {"provider", identity.provider},
      {"endpoint_class", identity.endpoint_class},
      {"model", identity.model},
      {"model_settings", nlohmann::ordered_json::parse(identity.settings)},
      {"prompt_id", advisor::PromptId()},
      {"overlay", prompt.overlay},
      {"route_text", prompt.route_text},
      {"rea", prompt.rea},
      {"reference_pool", pool ? pool->id() : ""},
      {"axes", prompt.axes},
      {"regions", prompt.regions},
      {"stretches", prompt.stretches},
      {"candidates", prompt.candidates},
      {"rounds", options.rounds},
      {"rounds_deadline_s", options.rounds_deadline_s},
      {"noise", options.noise_percent},
      {"seed", options.seed},
      {"polish", polish}};
  return json.dump(-1, ' ', false,
                   nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

PlanningCase PlanningCaseOf(const DatasetCase& c, const TerrainMap& map,
                            const planner::LatticePlan& baseline) {
  const auto sequence = c.extra.find("sequence");
  return {c.case_id,
          map,
          c.start,
          c.goal,
          baseline.waypoints,
          baseline.cost,
          sequence == c.extra.end() ? "" : sequence->second};
}

Result<LlmMethodChoice> MakeLlmMethod(const advisor::LlmBackendOptions& options,
                                      const LlmMethodForm& form) {
  Result<advisor::LlmService> service =
      advisor::MakeLlmService(options.service, advisor::AtLimit::kWait);
  if (!service.ok()) return service.error();
  Pool pool;
  if (options.method.prompt.rea &&
      options.method.method == advisor::Method::kAdvisor) {
    Result<Pool> loaded = advisor::LoadReferences(options.references);
    if (!loaded.ok()) return loaded.error();
    pool = *std::move(loaded);
  }
  const advisor::LlmIdentity identity = service->client->identity();
  MethodOptions method = options.method;
  method.rounds_deadline_s = options.service.provider.deadline_s;
  LlmMethodChoice made;
  made.settings_json = SettingsJson(method, identity, pool, form.polish);
  made.choice.info = InfoOf(options, identity, form);
  // The one client goes to whoever makes the method first.
  auto held = std::make_shared<advisor::LlmService>(*std::move(service));
  made.choice.make = [held, method, pool,
                      form]() -> Result<std::unique_ptr<Method>> {
    TERRA_REQUIRE(held->client != nullptr);  // One at a time, --jobs 1.
    return std::unique_ptr<Method>(
        std::make_unique<LlmMethod>(std::move(*held), method, pool, form));
  };
  return made;
}

}  // namespace terra::benchmark

#include <algorithm>
#include <span>
#include <utility>

#include "advisor/prompt.h"
#include "advisor/refiners.h"
#include "benchmark/method.h"
#include "benchmark/methods/comparison_refiners.h"
#include "benchmark/methods/controls.h"
#include "benchmark/single_search.h"
#include "benchmark/stopwatch.h"
#include "planner/optimum.h"
#include "terrain/segment.h"

namespace terra::benchmark {
namespace {

using Planner = std::function<Route(const MethodInput&)>;

struct NamedPlanner {
  std::string_view name;
  std::string_view title;
  CountingRule rule;
  bool uses_baseline;
  Planner plan;
};

constexpr CountingRule kGated{.fallback = true, .every_case_attempts = true};
constexpr CountingRule kAsReturned{.fallback = false,
                                   .every_case_attempts = true};

RefineInput InputOf(const MethodInput& input) {
  return {input.map, input.baseline.waypoints, input.baseline.cost};
}

template <advisor::RefineOutput (*refine)(const RefineInput&)>
Route Refined(const MethodInput& input) {
  return refine(InputOf(input)).route;
}

template <CampanaForm form>
Route Campana(const MethodInput& input) {
  return RefineByCampana(InputOf(input), form).route;
}

// Backends of `advisor` that need no model.
const std::vector<NamedPlanner>& Refiners() {
  static const std::vector<NamedPlanner> kRefiners = {
      {"search", "search (native optimum: upper bound, not a competitor)",
       kGated, true, Refined<advisor::RefineBySearch>},
      {"shortcut", "shortcut (cost-gated all-pairs, perturbed)", kGated, true,
       Refined<advisor::RefineByShortcut>},
      {"app", "APP-style (after the abstract)", kGated, true,
       Refined<RefineByAppStyle>},
      {"campana", "Campana (length objective, keep-best)", kGated, true,
       Campana<CampanaForm::kKeepBest>},
      {"campana-terrain", "Campana (terrain-weighted, keep-best)", kGated, true,
       Campana<CampanaForm::kTerrainWeighted>},
      {"band", "band (corridor of 25 around the baseline)", kGated, true,
       [](const MethodInput& input) {
         return RefineByBand(InputOf(input)).route;
       }},
  };
  return kRefiners;
}

Route OracleRoute(const MethodInput& input) {
  const SearchResult found = planner::FindOptimum(
      input.map, input.dataset_case.start, input.dataset_case.goal);
  return found.found() ? CornersOf(found.cells) : Route{};
}

// Methods that stand for themselves: references and controls.
const std::vector<NamedPlanner>& PlainMethods() {
  static const std::vector<NamedPlanner> kMethods = {
      {"coarse",
       "coarse-lattice A*",
       {},
       true,
       [](const MethodInput&) {
         return Route{};
       }},
      {"oracle", "native oracle (lower bound)", kGated, false, OracleRoute},
      {"campana-last", "Campana (length objective, last iterate)", kAsReturned,
       true, Campana<CampanaForm::kLastIterate>},
      {"collision-shortcut", "control: collision-only shortcut", kAsReturned,
       true, Refined<ShortcutWithoutCost>},
      {"straight-line", "control: straight line", kAsReturned, false,
       Refined<StraightLine>},
      {"corridor", "control: corridor of 25 around the baseline, no model",
       kGated, true,
       [](const MethodInput& input) {
         return RefineByBand(InputOf(input)).route;
       }},
      {"llm-astar-single",
       "control: LLM-A* in its original single search, no advice", kAsReturned,
       false,
       [](const MethodInput& input) {
         return SingleTargetedSearch(input.map, input.dataset_case.start,
                                     input.dataset_case.goal, {});
       }},
      {"blind-detours",
       "control: straight line and two blind detours, polished, no model",
       kGated, true, Refined<RefineByBlindDetours>},
  };
  return kMethods;
}

class DeterministicMethod : public Method {
 public:
  explicit DeterministicMethod(Planner plan) : plan_(std::move(plan)) {}

  Attempt Try(const MethodInput& input) override {
    Attempt attempt;
    const Stopwatch watch;
    Route route = plan_(input);
    attempt.t_det = watch.Seconds();
    // Only the coarse baseline plans nothing of its own.
    attempt.kind = route.empty() ? AttemptKind::kRetain : AttemptKind::kPropose;
    if (!route.empty()) attempt.candidates.push_back(std::move(route));
    return attempt;
  }

 private:
  Planner plan_;
};

std::vector<std::string> NamesOf(const std::vector<NamedPlanner>& planners) {
  std::vector<std::string> names;
  for (const NamedPlanner& planner : planners) names.emplace_back(planner.name);
  return names;
}

std::string Join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

MethodChoice Choose(std::string_view method, std::string_view backend,
                    const NamedPlanner& planner, bool gate) {
  MethodInfo info{std::string(method), std::string(backend),
                  std::string(planner.title), planner.rule,
                  planner.uses_baseline};
  if (gate && !info.rule.fallback) {
    info.rule.fallback = true;
    info.uses_baseline = true;
  }
  return {std::move(info),
          [plan = planner.plan]() -> Result<std::unique_ptr<Method>> {
            return std::unique_ptr<Method>(
                std::make_unique<DeterministicMethod>(plan));
          }};
}

std::string WhyNoMethod(std::string_view method, std::string_view backend) {
  if (method == "advisor") {
    return "no backend '" + std::string(backend) +
           "' without a model; there are " + Join(RefinerNames());
  }
  if (advisor::FindMethod(method)) {
    return std::string(method) +
           " asks a model: --backend openai, or another one with a model";
  }
  return "no method '" + std::string(method) + "'; there are advisor, " +
         Join(PlainMethodNames());
}

}  // namespace

std::optional<bool> FallsBack(std::string_view method) {
  if (method == "advisor") return true;
  if (advisor::FindMethod(method)) return false;
  for (const NamedPlanner& planner : PlainMethods()) {
    if (planner.name == method) return planner.rule.fallback;
  }
  return std::nullopt;
}

std::string TitleWithGate(const MethodInfo& info) {
  const bool given = info.rule.fallback && FallsBack(info.method) == false;
  return info.title + (given ? " + gate" : "");
}

Result<MethodChoice> FindDeterministicMethod(std::string_view method,
                                             std::string_view backend,
                                             bool gate) {
  const bool advisor = method == "advisor";
  const std::string_view wanted = advisor ? backend : method;
  for (const NamedPlanner& planner : advisor ? Refiners() : PlainMethods()) {
    if (planner.name != wanted) continue;
    if (!advisor && !backend.empty()) {
      return Error{ErrorCode::kInvalid, std::string(method) +
                                            " takes no backend '" +
                                            std::string(backend) + "'"};
    }
    return Choose(method, backend, planner, gate);
  }
  return Error{ErrorCode::kNotFound, WhyNoMethod(method, backend)};
}

std::vector<std::string> RefinerNames() {
  return NamesOf(Refiners());
}
std::vector<std::string> PlainMethodNames() {
  return NamesOf(PlainMethods());
}

}  // namespace terra::benchmark

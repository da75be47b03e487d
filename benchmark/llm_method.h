#pragma once

#include <string>

#include "advisor/llm_backend.h"
#include "advisor/llm_methods.h"
#include "benchmark/method.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A dataset's case as a question is prepared from it. Refers to its arguments.
advisor::PlanningCase PlanningCaseOf(const DatasetCase& dataset_case,
                                     const TerrainMap& map,
                                     const planner::LatticePlan& baseline);

/// A method that asks a model, and the settings that decide its answers.
struct LlmMethodChoice {
  MethodChoice choice;
  std::string settings_json;
};

/// What is made of the answers.
struct LlmMethodForm {
  /// Every candidate of `advisor` is made the best of inside its corridor
  /// before it is verified; a Yes stays a Yes.
  bool polish = false;
  bool gate = false;  ///< As FindDeterministicMethod.
  /// `llm-astar` in its original form: SingleTargetedSearch instead of legs.
  bool single_search = false;
};

/// Returns `advisor`, `direct` or `llm-astar` with a backend of a model (a
/// provider, a recording, a person). Rate and spend limits pause a run; they
/// never fail a case. Calls go one at a time, so the method is made only once.
/// Errors: as advisor::MakeLlmService and LoadReferences.
Result<LlmMethodChoice> MakeLlmMethod(const advisor::LlmBackendOptions& options,
                                      const LlmMethodForm& form);

}  // namespace terra::benchmark

#pragma once

#include <string>

#include "advisor/llm_backend.h"
#include "benchmark/method.h"
#include "terrain/result.h"

namespace terra::benchmark {

/// A method that asks a model, and the settings that decide its answers.
struct LlmMethodChoice {
  MethodChoice choice;
  std::string settings_json;
};

/// Returns `advisor`, `direct` or `llm-astar` with a backend of a model (a
/// provider, a recording, a person). Rate and spend limits pause a run; they
/// never fail a case. Calls go one at a time, so the method is made only once.
///
/// `polish`: every candidate of `advisor` is made the best of inside its
/// corridor before it is verified; a Yes stays a Yes.
/// `gate`: as FindDeterministicMethod.
/// Errors: as advisor::MakeLlmService and LoadReferences.
Result<LlmMethodChoice> MakeLlmMethod(const advisor::LlmBackendOptions& options,
                                      bool polish, bool gate);

}  // namespace terra::benchmark

#pragma once

#include <string>

#include "advisor/llm_backend.h"
#include "advisor/llm_methods.h"

namespace CLI {
class App;
}

namespace terra::advisor {

/// Adds what shapes the question: --method, --picture, --candidates,
/// --references (a pool file), --seed and the like.
void AddPromptOptions(CLI::App& app, MethodOptions& method,
                      std::string& references);

/// Adds what only experiments want: parts of the question left out, noise on
/// the map. A robot's advisor has none of these.
void AddExperimentOptions(CLI::App& app, MethodOptions& method);

/// Adds what a model is asked with: --model, token limit, effort, image detail.
void AddSettingsOptions(CLI::App& app, GenerationSettings& settings);

/// Adds these, and what says who is asked, how, and within which limits. The
/// defaults are the structs' own. `--backend` is the caller's.
void AddLlmOptions(CLI::App& app, LlmBackendOptions& options);

}  // namespace terra::advisor

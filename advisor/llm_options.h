#pragma once

#include <string>

#include "advisor/llm_backend.h"
#include "advisor/llm_methods.h"

namespace CLI {
class App;
}

namespace terra::advisor {

/// Adds only what shapes the question: --method, switches, --references (a pool
/// file), noise, seed.
void AddPromptOptions(CLI::App& app, MethodOptions& method,
                      std::string& references);

/// Adds what a model is asked with: --model, token limit, effort, image detail.
void AddSettingsOptions(CLI::App& app, GenerationSettings& settings);

/// Adds these, and what says who is asked, how, and within which limits. The
/// defaults are the structs' own. `--backend` is the caller's.
void AddLlmOptions(CLI::App& app, LlmBackendOptions& options);

}  // namespace terra::advisor

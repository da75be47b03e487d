#pragma once

#include <memory>
#include <string>

#include "advisor/backend.h"
#include "advisor/llm_backend.h"
#include "terrain/result.h"

namespace CLI {
class App;
}

namespace terra::advisor {

/// Which advisor, and how an LLM one is asked.
struct AdvisorOptions {
  std::string backend = "search";
  bool polish = false;  ///< See PolishingBackend.
  LlmBackendOptions llm;
};

/// Adds --backend, --polish and the options of the LLM backends.
void AddAdvisorOptions(CLI::App& app, AdvisorOptions& options);

/// Makes the backend that the options name.
/// Errors: what its making says (a missing key, an address not allowed, ...).
Result<std::unique_ptr<Backend>> MakeBackend(const AdvisorOptions& options);

}  // namespace terra::advisor

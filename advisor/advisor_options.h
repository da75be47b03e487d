#pragma once

#include <functional>
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

/// Reads a pool of references, and gives a function that returns it: newly read
/// when the file has changed since. One that cannot be read then leaves the
/// pool before in use and is said on stderr.
/// Errors: as LoadReferences.
Result<std::function<std::shared_ptr<const ReferencePool>()>> WatchReferences(
    const std::string& path);

/// Makes the backend that the options name.
/// Errors: what its making says (a missing key, an address not allowed, ...).
Result<std::unique_ptr<Backend>> MakeBackend(const AdvisorOptions& options);

}  // namespace terra::advisor

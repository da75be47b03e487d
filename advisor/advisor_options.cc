#include "advisor/advisor_options.h"

#include <vector>

#include <CLI/CLI.hpp>

#include "advisor/llm_options.h"
#include "advisor/llm_service.h"
#include "advisor/refiner_backend.h"

namespace terra::advisor {

void AddAdvisorOptions(CLI::App& app, AdvisorOptions& options) {
  std::vector<std::string> names = RefinerBackendNames();
  for (const std::string_view name : kLlmBackendNames) names.emplace_back(name);
  app.add_option("--backend", options.backend, "Who looks for routes")
      ->capture_default_str()
      ->check(CLI::IsMember(names))
      ->type_name("B");
  AddLlmOptions(app, options.llm);
  app.add_flag("--polish", options.llm.polish,
               "Also propose each route of a model repaired and refined in a "
               "corridor around it")
      ->group("Prompt");
}

Result<std::unique_ptr<Backend>> MakeBackend(const AdvisorOptions& options) {
  if (auto refiner = MakeRefinerBackend(options.backend)) return refiner;
  LlmBackendOptions llm = options.llm;
  llm.service.backend = options.backend;
  return LlmBackend::Create(llm);
}

}  // namespace terra::advisor

#include "advisor/advisor_options.h"

#include <vector>

#include <CLI/CLI.hpp>

#include "advisor/llm_options.h"
#include "advisor/llm_service.h"
#include "advisor/polishing_backend.h"
#include "advisor/refiner_backend.h"

namespace terra::advisor {
namespace {

Result<std::unique_ptr<Backend>> MakePlainBackend(
    const AdvisorOptions& options) {
  if (auto refiner = MakeRefinerBackend(options.backend)) return refiner;
  LlmBackendOptions llm = options.llm;
  llm.service.backend = options.backend;
  return LlmBackend::Create(llm);
}

}  // namespace

void AddAdvisorOptions(CLI::App& app, AdvisorOptions& options) {
  std::vector<std::string> names = RefinerBackendNames();
  for (const std::string_view name : kLlmBackendNames) names.emplace_back(name);
  app.add_option("--backend", options.backend, "Who looks for routes")
      ->capture_default_str()
      ->check(CLI::IsMember(names))
      ->type_name("B");
  app.add_flag("--polish", options.polish,
               "Also send each proposal repaired and improved in a corridor "
               "around it");
  AddLlmOptions(app, options.llm);
}

Result<std::unique_ptr<Backend>> MakeBackend(const AdvisorOptions& options) {
  Result<std::unique_ptr<Backend>> backend = MakePlainBackend(options);
  if (!backend || !options.polish) return backend;
  return std::unique_ptr<Backend>(
      std::make_unique<PolishingBackend>(*std::move(backend)));
}

}  // namespace terra::advisor

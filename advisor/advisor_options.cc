#include "advisor/advisor_options.h"

#include <optional>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "advisor/llm_options.h"
#include "advisor/llm_service.h"
#include "advisor/polishing_backend.h"
#include "advisor/refiner_backend.h"
#include "bus/log.h"
#include "terrain/files/file_watch.h"

namespace terra::advisor {
namespace {

// A pool and the file that it is from.
class WatchedReferences {
 public:
  explicit WatchedReferences(std::string path)
      : path_(std::move(path)), watch_([this]() -> Status {
          OpenedFiles::Note(path_);
          auto pool = LoadReferences(path_);
          if (!pool) return pool.error();
          pool_ = *std::move(pool);
          return Done{};
        }) {}

  Status Begin() { return watch_.Begin(); }

  std::shared_ptr<const ReferencePool> Latest() {
    const std::optional<Status> read = watch_.ReadIfChanged();
    if (read && !read->ok()) {
      bus::LogWarning("references not reloaded: " + read->error().message);
    }
    return pool_;
  }

 private:
  std::string path_;
  FileWatch watch_;
  std::shared_ptr<const ReferencePool> pool_;
};

Result<std::unique_ptr<Backend>> MakePlainBackend(
    const AdvisorOptions& options) {
  if (auto refiner = MakeRefinerBackend(options.backend)) return refiner;
  LlmBackendOptions llm = options.llm;
  llm.service.backend = options.backend;
  if (!llm.references.empty()) {
    auto references = WatchReferences(llm.references);
    if (!references) return references.error();
    llm.latest_references = *std::move(references);
  }
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

Result<std::function<std::shared_ptr<const ReferencePool>()>> WatchReferences(
    const std::string& path) {
  const auto watched = std::make_shared<WatchedReferences>(path);
  const Status read = watched->Begin();
  if (!read.ok()) return read.error();
  return std::function([watched] {
    return watched->Latest();
  });
}

Result<std::unique_ptr<Backend>> MakeBackend(const AdvisorOptions& options) {
  Result<std::unique_ptr<Backend>> backend = MakePlainBackend(options);
  if (!backend || !options.polish) return backend;
  return std::unique_ptr<Backend>(
      std::make_unique<PolishingBackend>(*std::move(backend)));
}

}  // namespace terra::advisor

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "advisor/backend.h"
#include "advisor/llm_methods.h"
#include "advisor/llm_service.h"
#include "terrain/result.h"

namespace terra::advisor {

/// How an LLM advises.
struct LlmBackendOptions {
  LlmServiceOptions service;
  MethodOptions method;
  std::string references;  ///< Pool file; empty = the one that comes along.
  /// Asked for the pool before each case, where that may change; empty = the
  /// file is read once. Called by one thread at a time.
  std::function<std::shared_ptr<const ReferencePool>()> latest_references;
  /// Percent of the baseline's cost. When the native optimum (a lower bound of
  /// every route) promises less, nobody is asked; 0 = always ask.
  double min_gain_percent = 0;
};

/// A language model as an advisor: prepares the question, asks, reads the
/// answer. Values of tasks and answers only; the bus is the caller's business.
///
/// Threads: as Backend. Limits refuse a call at once (AtLimit::kRefuse).
class LlmBackend : public Backend {
 public:
  /// Errors: as MakeLlmService and LoadReferences.
  static Result<std::unique_ptr<Backend>> Create(
      const LlmBackendOptions& options);

  /// `pool` may be null (no REA).
  LlmBackend(std::string name, LlmService service,
             const LlmBackendOptions& options,
             std::shared_ptr<const ReferencePool> pool);

  std::string name() const override { return name_; }
  std::string method() const override;
  AdviceAnswer Advise(const AdviceTask& task, std::stop_token stop) override;
  BackendFigures figures() const override;
  std::string notice() const override;
  /// The paper's online models took up to 22 s in 95 of 100 cases.
  double usual_seconds() const override { return 25; }

 private:
  bool simulated() const;
  bool WorthAsking(const AdviceTask& task) const;
  void Keep(const MethodOutcome& outcome, const LlmReply& reply,
            AdviceAnswer& answer) const;

  std::string name_;
  LlmService service_;
  MethodOptions method_;
  double min_gain_percent_;
  std::function<std::shared_ptr<const ReferencePool>()> latest_references_;
  std::shared_ptr<const ReferencePool> pool_;  // Of the advising thread.
  mutable std::mutex mutex_;
  std::int64_t skipped_ = 0;
};

/// Reads a pool of references; the one that comes along for an empty path.
/// Errors: no such file, or what is wrong in it.
Result<std::shared_ptr<const ReferencePool>> LoadReferences(
    const std::string& path);

/// What a case on the bus, or outside any dataset, is called: map_id, start and
/// goal.
std::string BusCaseId(std::int64_t map_id, Cell start, Cell goal);

}  // namespace terra::advisor

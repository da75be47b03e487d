#pragma once

#include <memory>
#include <string>

#include "advisor/backend.h"

namespace terra::advisor {

/// Puts a polished form of each proposal before what another backend proposes:
/// polished ones first, the cheapest leading, then the answer as it was. Both
/// are judged, and reports tell them apart by Candidate::polished.
///
/// A retention, a malformed answer and a failure stay what they are. Proposals
/// that polishing makes no cheaper than the baseline, or does not change, are
/// not sent twice.
/// Threads: as Backend.
class PolishingBackend : public Backend {
 public:
  explicit PolishingBackend(std::unique_ptr<Backend> inner);

  std::string name() const override { return inner_->name(); }
  std::string method() const override { return inner_->method(); }
  AdviceAnswer Advise(const AdviceTask& task, std::stop_token stop) override;
  BackendFigures figures() const override { return inner_->figures(); }
  std::string notice() const override { return inner_->notice(); }
  double usual_seconds() const override { return inner_->usual_seconds(); }

 private:
  std::unique_ptr<Backend> inner_;
};

}  // namespace terra::advisor

#include "advisor/refiner_backend.h"

#include <utility>

#include "advisor/refiners.h"

namespace terra::advisor {
namespace {

using Refiner = RefineOutput (*)(const RefineInput&);

struct NamedRefiner {
  std::string_view name;
  Refiner refine;
};

constexpr NamedRefiner kRefiners[] = {
    {"search", RefineBySearch},
    {"shortcut", RefineByShortcut},
};

class RefinerBackend : public Backend {
 public:
  explicit RefinerBackend(NamedRefiner refiner) : refiner_(refiner) {}

  std::string name() const override { return std::string(refiner_.name); }
  std::string method() const override { return "refiner"; }

  AdviceAnswer Advise(const AdviceTask& task, std::stop_token stop) override {
    RefineOutput output = refiner_.refine(
        RefineInput{task.map, task.baseline, task.baseline_cost, stop});
    AdviceAnswer answer;
    answer.form = AnswerForm::kExact;
    if (output.cost < task.baseline_cost) {
      answer.kind = AnswerKind::kPropose;
      answer.candidates.push_back(Candidate{std::move(output.route), false});
    } else {
      answer.kind = AnswerKind::kRetain;
    }
    return answer;
  }

 private:
  NamedRefiner refiner_;
};

}  // namespace

std::unique_ptr<Backend> MakeRefinerBackend(std::string_view name) {
  for (const NamedRefiner& refiner : kRefiners) {
    if (refiner.name == name) return std::make_unique<RefinerBackend>(refiner);
  }
  return nullptr;
}

std::vector<std::string> RefinerBackendNames() {
  std::vector<std::string> names;
  for (const NamedRefiner& refiner : kRefiners) {
    names.emplace_back(refiner.name);
  }
  return names;
}

}  // namespace terra::advisor

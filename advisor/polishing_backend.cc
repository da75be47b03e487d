#include "advisor/polishing_backend.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "advisor/polish.h"

namespace terra::advisor {

PolishingBackend::PolishingBackend(std::unique_ptr<Backend> inner)
    : inner_(std::move(inner)) {}

AdviceAnswer PolishingBackend::Advise(const AdviceTask& task,
                                      std::stop_token stop) {
  AdviceAnswer answer = inner_->Advise(task, stop);
  if (answer.kind != AnswerKind::kPropose) return answer;
  const RefineInput input{task.map, task.baseline, task.baseline_cost, stop};
  std::vector<RefineOutput> polished;
  for (const Candidate& raw : answer.candidates) {
    if (stop.stop_requested()) break;
    RefineOutput output = Polish(input, raw.route);
    if (output.cost < task.baseline_cost && output.route != raw.route) {
      polished.push_back(std::move(output));
    }
  }
  std::stable_sort(polished.begin(), polished.end(),
                   [](const RefineOutput& a, const RefineOutput& b) {
                     return a.cost < b.cost;
                   });
  std::vector<Candidate> candidates;
  for (RefineOutput& output : polished) {
    const bool repeats = std::any_of(candidates.begin(), candidates.end(),
                                     [&](const Candidate& sent) {
                                       return sent.route == output.route;
                                     });
    if (repeats) continue;
    candidates.push_back({std::move(output.route), true});
  }
  std::move(answer.candidates.begin(), answer.candidates.end(),
            std::back_inserter(candidates));
  answer.candidates = std::move(candidates);
  return answer;
}

}  // namespace terra::advisor

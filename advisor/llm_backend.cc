#include "advisor/llm_backend.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "advisor/llm_rounds.h"
#include "terrain/native_search.h"
#include "terrain/route_text.h"

namespace terra::advisor {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t Microseconds(double seconds) {
  return std::llround(seconds * 1e6);
}

std::int64_t MicrosecondsSince(Clock::time_point begin) {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() -
                                                               begin)
      .count();
}

/// Why there is no route: the word that programs read, then the detail.
std::string Reason(const std::string& cause, const std::string& detail) {
  return detail.empty() ? cause : cause + ": " + detail;
}

/// Leaves out cells in the middle of straight runs. A run along one of the 8
/// directions visits the same cells without them.
Route WithoutMidRunCells(const Route& cells) {
  Route kept;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool inner = i > 0 && i + 1 < cells.size();
    if (inner && cells[i].x - cells[i - 1].x == cells[i + 1].x - cells[i].x &&
        cells[i].y - cells[i - 1].y == cells[i + 1].y - cells[i].y) {
      continue;
    }
    kept.push_back(cells[i]);
  }
  return kept;
}

}  // namespace

std::string BusCaseId(std::int64_t map_id, Cell start, Cell goal) {
  return std::to_string(map_id) + " " + FormatRoute({start, goal});
}

Result<std::shared_ptr<const ReferencePool>> LoadReferences(
    const std::string& path) {
  if (path.empty()) {
    // It lives as long as the program: nothing to free.
    return std::shared_ptr<const ReferencePool>(std::shared_ptr<void>(),
                                                &ReferencePool::Builtin());
  }
  std::ifstream file(path, std::ios::binary);
  std::error_code failed;
  if (!file || std::filesystem::is_directory(path, failed)) {
    return Error{ErrorCode::kNotFound, path + ": no such reference pool"};
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto pool = ReferencePool::Parse(text);
  if (!pool)
    return Error{pool.error().code, path + ": " + pool.error().message};
  return std::make_shared<const ReferencePool>(*std::move(pool));
}

Result<std::unique_ptr<Backend>> LlmBackend::Create(
    const LlmBackendOptions& options) {
  auto service = MakeLlmService(options.service, AtLimit::kRefuse);
  if (!service) return service.error();
  using Pool = Result<std::shared_ptr<const ReferencePool>>;
  auto pool = options.latest_references ? Pool(options.latest_references())
                                        : LoadReferences(options.references);
  if (!pool) return pool.error();
  return std::unique_ptr<Backend>(std::make_unique<LlmBackend>(
      options.service.backend, *std::move(service), options, *std::move(pool)));
}

LlmBackend::LlmBackend(std::string name, LlmService service,
                       const LlmBackendOptions& options,
                       std::shared_ptr<const ReferencePool> pool)
    : name_(std::move(name)),
      service_(std::move(service)),
      method_(options.method),
      min_gain_percent_(options.min_gain_percent),
      latest_references_(options.latest_references),
      pool_(std::move(pool)) {
  method_.rounds_deadline_s = options.service.provider.deadline_s;
}

std::string LlmBackend::method() const {
  return std::string(MethodName(method_.method));
}

bool LlmBackend::simulated() const {
  return service_.client->identity().endpoint_class == "loopback";
}

std::string LlmBackend::notice() const {
  return simulated() ? "SIMULATED: the answers are those of a program on this "
                       "machine, not of a model (--real-model says that it "
                       "runs one)"
                     : "";
}

bool LlmBackend::WorthAsking(const AdviceTask& task) const {
  if (min_gain_percent_ <= 0) return true;
  const double enough = task.baseline_cost * (1 - min_gain_percent_ / 100);
  NativeSearchOptions bound;
  bound.upper_bound = enough;
  return NativeSearch(task.map, task.start, task.goal, bound).found();
}

AdviceAnswer LlmBackend::Advise(const AdviceTask& task, std::stop_token stop) {
  AdviceAnswer answer;
  const auto begin = Clock::now();
  if (!WorthAsking(task)) {
    const std::lock_guard lock(mutex_);
    ++skipped_;
    answer.error = "skipped: no route can be cheaper by --min-gain";
    return answer;
  }
  const PlanningCase planning_case{
      BusCaseId(task.map_id, task.start, task.goal),
      task.map,
      task.start,
      task.goal,
      task.baseline,
      task.baseline_cost,
      ""};
  if (latest_references_) pool_ = latest_references_();
  const PreparedCase prepared =
      PrepareCase(planning_case, method_, pool_.get());
  answer.t_prep_us = MicrosecondsSince(begin);
  const AskedCase asked = AskInRounds(planning_case, method_, prepared.request,
                                      *service_.client, stop);
  answer.request_hash = asked.request_hash;
  Keep(asked.outcome, asked.reply, answer);
  return answer;
}

void LlmBackend::Keep(const MethodOutcome& outcome, const LlmReply& reply,
                      AdviceAnswer& answer) const {
  answer.kind = outcome.kind;
  answer.form = outcome.form;
  answer.model =
      reply.model.empty() ? service_.client->identity().model : reply.model;
  answer.simulated = simulated();
  answer.answer_text = reply.text;
  answer.tokens_in = reply.usage.tokens_in;
  answer.tokens_out = reply.usage.tokens_out;
  answer.spend_usd = reply.spend_usd.value_or(0);
  answer.t_llm_us = Microseconds(reply.t_llm_s);
  answer.error = outcome.cause.empty()
                     ? reply.error  // Such as: it could not be recorded.
                     : Reason(outcome.cause, outcome.detail);
  for (const OutcomeCandidate& candidate : outcome.candidates) {
    if (!candidate.fault.empty()) {
      answer.error = Reason(answer.error, candidate.fault);
      continue;
    }
    answer.candidates.push_back({method_.method == Method::kLlmAstar
                                     ? WithoutMidRunCells(candidate.route)
                                     : candidate.route,
                                 false});
  }
  if (answer.kind == AnswerKind::kPropose && answer.candidates.empty()) {
    answer.kind = AnswerKind::kMalformed;
  }
}

BackendFigures LlmBackend::figures() const {
  const CallFigures calls = service_.monitor->figures();
  const CallStatistics& statistics = calls.statistics;
  BackendFigures figures;
  if (Clock::now() < calls.paused_until)
    figures.state = "failing: breaker open";
  std::int64_t skipped = 0;
  {
    const std::lock_guard lock(mutex_);
    skipped = skipped_;
  }
  const auto latency_ms = [&statistics](double percent) {
    return std::llround(statistics.latency_percentile_s(percent) * 1e3);
  };
  figures.counters = {
      {"llm_calls", statistics.calls()},
      {"llm_no_answer", statistics.no_answers()},
      {"llm_skipped", skipped},
      {"llm_p50_ms", latency_ms(50)},
      {"llm_p95_ms", latency_ms(95)},
      {"tokens_in", statistics.tokens_in()},
      {"tokens_out", statistics.tokens_out()},
      {"spend_micro_usd", Microseconds(statistics.spend_usd())},
      {"spend_hour_micro_usd", Microseconds(calls.spend_last_hour_usd)},
  };
  return figures;
}

}  // namespace terra::advisor

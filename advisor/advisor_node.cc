#include "advisor/advisor_node.h"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <utility>

#include <sys/resource.h>
#include <sys/syscall.h>

#include "bus/codec.h"
#include "terrain/route_cost.h"

namespace terra::advisor {
namespace {

using terra_msg::advice_t;
using terra_msg::baseline_t;

// Cuts text to what its message may carry.
std::string Limited(std::string text, std::size_t max_bytes) {
  if (text.size() > max_bytes) text.resize(max_bytes);
  return text;
}

advice_t ToMessage(const AdviceWorker::Job& job, const AdviceAnswer& answer) {
  advice_t message{};
  message.request_id = job.baseline.request_id;
  message.map_id = job.baseline.map_id;
  message.baseline_digest = job.baseline.baseline_digest;
  message.anchor_x = job.baseline.start_x;
  message.anchor_y = job.baseline.start_y;
  message.model = Limited(answer.model, bus::kMaxNameBytes);
  message.kind = static_cast<std::int8_t>(answer.kind);
  message.form = static_cast<std::int8_t>(answer.form);
  message.request_hash = answer.request_hash;
  message.answer_text = Limited(answer.answer_text, bus::kMaxAnswerBytes);
  message.tokens_in = answer.tokens_in;
  message.tokens_out = answer.tokens_out;
  message.spend_usd = answer.spend_usd;
  message.t_prep_us = answer.t_prep_us;
  message.t_llm_us = answer.t_llm_us;
  message.advice_error = Limited(answer.error, 1'000);
  return message;
}

// The deployed path goes first where cores are few: measured on two, baselines
// waited 4 ms behind a search of normal priority.
void LowerOwnPriority() {
  constexpr int kNice = 10;
  // Without effect where it is refused; then the work is done all the same.
  static_cast<void>(::setpriority(
      PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), kNice));
}

}  // namespace

// THREADING: one worker thread runs Backend::Advise. It shares with the acting
// thread only the members under mutex_: one job waiting (a newer one takes its
// place), one answer. `current_` is replaced with every job, so a stop request
// reaches the job it was meant for and no other.
AdviceWorker::AdviceWorker(std::unique_ptr<Backend> backend,
                           std::function<void()> ready)
    : backend_(std::move(backend)),
      ready_(std::move(ready)),
      thread_([this](std::stop_token end) {
        LowerOwnPriority();
        Work(end);
      }) {}

void AdviceWorker::Start(Job job) {
  const std::lock_guard lock(mutex_);
  current_.request_stop();
  done_.reset();
  waiting_ = std::move(job);
  changed_.notify_all();
}

void AdviceWorker::Cancel() {
  const std::lock_guard lock(mutex_);
  current_.request_stop();
  waiting_.reset();
  done_.reset();
}

std::optional<AdviceWorker::Done> AdviceWorker::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

bool AdviceWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_ || waiting_.has_value();
}

void AdviceWorker::Work(std::stop_token end) {
  // Ends a call that is still running when the process ends.
  const std::stop_callback stop_current(end, [this] {
    const std::lock_guard lock(mutex_);
    current_.request_stop();
  });
  while (!end.stop_requested()) {
    Job job;
    std::stop_token stop;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, end, [this] {
            return waiting_.has_value();
          })) {
        return;
      }
      job = *std::exchange(waiting_, std::nullopt);
      current_ = std::stop_source();
      stop = current_.get_token();
      busy_ = true;
    }
    AdviceAnswer answer;
    try {
      answer = backend_->Advise(
          AdviceTask{job.map->map, job.baseline.map_id, job.baseline.request_id,
                     Cell{job.baseline.start_x, job.baseline.start_y},
                     Cell{job.baseline.goal_x, job.baseline.goal_y}, job.route,
                     job.baseline_cost},
          stop);
    } catch (const std::exception& error) {
      answer = AdviceAnswer{};
      answer.error = error.what();
    }
    {
      const std::lock_guard lock(mutex_);
      busy_ = false;
      if (stop.stop_requested()) continue;
      done_ = Done{std::move(job), std::move(answer)};
    }
    ready_();
  }
}

AdvisorNode::AdvisorNode(std::string name, std::unique_ptr<Backend> backend,
                         bus::Outbox& out, bus::Outbox& advice,
                         std::function<void()> wake)
    : name_(std::move(name)),
      advice_(advice),
      map_(out),
      worker_(std::move(backend), std::move(wake)) {
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time now) {
    if (map_.OnHeader(message, now)) Begin();
  });
  Listen<terra_msg::map_tile_t>([this](const auto& message, bus::Time now) {
    if (map_.OnTiles(message, now)) Begin();
  });
  Listen<baseline_t>([this](const auto& message, bus::Time) {
    OnBaseline(message);
  });
}

void AdvisorNode::OnBaseline(const baseline_t& message) {
  if (!planner_.Accept(message.session, message.seq)) return;
  const bool same = message.request_id == baseline_.request_id &&
                    message.map_id == baseline_.map_id &&
                    message.status == baseline_.status &&
                    message.baseline_digest == baseline_.baseline_digest;
  if (same) return;
  baseline_ = message;
  Begin();
}

// Starts on the baseline in hand, if there is a map and a route to improve.
void AdvisorNode::Begin() {
  worker_.Cancel();
  current_.clear();
  if (!map_.map() || baseline_.map_id != map_.map_id() ||
      baseline_.status != baseline_t::STATUS_OK) {
    return;
  }
  Route route = bus::WaypointsOf(baseline_);
  if (route.size() < 2) return;
  const double cost = WalkRoute(map_.map()->map, route, bus::kMaxSteps).cost;
  if (cost == kImpassable) return;  // the gate will say why
  worker_.Start(AdviceWorker::Job{++jobs_, map_.map(), baseline_,
                                  std::move(route), cost});
}

void AdvisorNode::Publish(const AdviceWorker::Done& done, bus::Time now) {
  ++answers_;
  if (done.answer.kind == AnswerKind::kFailed) {
    ++failures_;
    last_error_ = done.answer.error;
  }
  current_.clear();
  const std::size_t num_messages =
      std::max<std::size_t>(1, done.answer.candidates.size());
  for (std::size_t i = 0; i < num_messages; ++i) {
    advice_t message = ToMessage(done.job, done.answer);
    message.advisor = name_;
    message.method = worker_.backend().method();
    message.backend = worker_.backend().name();
    message.attempt = done.job.number;
    message.candidate = static_cast<std::int32_t>(i) + 1;
    if (i < done.answer.candidates.size()) {
      const Candidate& candidate = done.answer.candidates[i];
      message.polished = candidate.polished ? 1 : 0;
      if (candidate.route.size() > bus::kMaxWaypoints) {
        message.kind = advice_t::KIND_MALFORMED;
        message.advice_error = "more than 2048 waypoints";
      } else {
        bus::SetWaypoints(message, candidate.route);
      }
    }
    advice_.Send(message);
    current_.push_back(std::move(message));
  }
  repeat_.Postpone(now);
}

bus::Time AdvisorNode::Advance(bus::Time now) {
  if (const auto done = worker_.Take()) Publish(*done, now);
  if (!current_.empty() && repeat_.Due(now)) {
    for (advice_t& message : current_) advice_.Send(message);
  }
  const bus::Time repeat = current_.empty() ? bus::kNever : repeat_.next();
  return std::min(map_.Advance(now), repeat);
}

std::string AdvisorNode::state() const {
  if (!map_.map()) return map_.state();
  const std::string special = worker_.backend().figures().state;
  if (!special.empty()) return special;
  return worker_.busy() ? "working" : "ready";
}

std::string AdvisorNode::last_error() const {
  return last_error_.empty() ? map_.last_error() : last_error_;
}

void AdvisorNode::AddCounters(bus::Counters& counters) const {
  Node::AddCounters(counters);
  counters.emplace_back("jobs", jobs_);
  counters.emplace_back("answers", answers_);
  counters.emplace_back("failures", failures_);
  counters.emplace_back("queue", worker_.busy() ? 1 : 0);
  for (auto& counter : worker_.backend().figures().counters) {
    counters.push_back(std::move(counter));
  }
  counters.emplace_back("from_replaced_planner", planner_.from_replaced());
}

}  // namespace terra::advisor

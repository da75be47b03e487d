#include "cli/monitor_node.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "cli/output.h"
#include "cli/status_counter.h"
#include "verifier/verify.h"

namespace terra::cli {
namespace {

using terra_msg::deployed_t;
using terra_msg::status_t;
using terra_msg::verdict_t;

// Names come from the bus: a flood of made-up ones must not fill the memory or
// the screen.
constexpr std::size_t kMaxProcesses = 64;
constexpr std::size_t kShownVerdicts = 8;
// Three heartbeats missed: gone or stuck.
constexpr bus::Duration kSilent = std::chrono::seconds(3);
// A process that has been silent so long is no longer listed.
constexpr bus::Duration kForgotten = std::chrono::minutes(2);

const char* ModeName(std::int8_t mode) {
  switch (mode) {
    case deployed_t::MODE_BASELINE:
      return "baseline";
    case deployed_t::MODE_CANDIDATE:
      return "candidate";
    case deployed_t::MODE_HOLD:
      return "hold: no valid route";
    default:
      return "none";
  }
}

double Seconds(bus::Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

// What an advisor's calls to a model came to; empty for other processes.
std::string ModelLine(const status_t& status) {
  if (!CounterOf(status, "llm_calls")) return "";
  const auto count = [&status](const char* name) {
    return static_cast<long long>(CounterOf(status, name).value_or(0));
  };
  const auto dollars = [&count](const char* name) {
    return static_cast<double>(count(name)) / 1e6;
  };
  return Printed(
             "      %lld calls (%lld without answer, %lld skipped), %lld "
             "running, p50 %lld ms, p95 %lld ms\n",
             count("llm_calls"), count("llm_no_answer"), count("llm_skipped"),
             count("queue"), count("llm_p50_ms"), count("llm_p95_ms")) +
         Printed(
             "      %lld tokens in, %lld out, $%.4f, in the last hour $%.4f\n",
             count("tokens_in"), count("tokens_out"),
             dollars("spend_micro_usd"), dollars("spend_hour_micro_usd"));
}

}  // namespace

MonitorNode::MonitorNode(bus::Duration duration, Show show)
    : duration_(duration), show_(std::move(show)) {
  Listen<status_t>([this](const auto& message, bus::Time now) {
    OnStatus(message, now);
  });
  Listen<verdict_t>([this](const auto& message, bus::Time) {
    OnVerdict(message);
  });
  Listen<deployed_t>([this](const auto& message, bus::Time now) {
    deployed_ = message;
    deployed_at_ = now;
  });
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time) {
    map_ = message;
  });
}

void MonitorNode::OnStatus(const status_t& message, bus::Time now) {
  const std::string key = message.status_name + "@" + message.host;
  if (processes_.size() >= kMaxProcesses && !processes_.contains(key)) return;
  processes_[key] = {message, now};
}

void MonitorNode::OnVerdict(const verdict_t& message) {
  verdicts_.push_front(message);
  if (verdicts_.size() > kShownVerdicts) verdicts_.pop_back();
}

bus::Time MonitorNode::Advance(bus::Time now) {
  if (!started_) {
    started_ = true;
    if (duration_ < bus::kNever - now) end_ = now + duration_;
    refresh_.Postpone(now);  // One round of heartbeats first.
  }
  std::erase_if(processes_, [now](const auto& entry) {
    return now - entry.second.heard_at > kForgotten;
  });
  done_ = now >= end_;
  if (refresh_.Due(now) || done_) done_ = !show_(View(now)) || done_;
  return std::min(refresh_.next(), end_);
}

std::string MonitorNode::View(bus::Time now) const {
  return RouteLines(now) + VerdictLines() + ProcessLines(now);
}

std::string MonitorNode::RouteLines(bus::Time now) const {
  std::string text = "map        ";
  text += map_ ? Printed("%d x %d, id %016llx, revision %lld\n", map_->width,
                         map_->height,
                         static_cast<unsigned long long>(map_->map_id),
                         static_cast<long long>(map_->map_revision))
               : "none heard; is terra-map running on this bus?\n";
  if (!deployed_) {
    return text + "deployed   nothing heard; is terra-verifier running?\n";
  }
  text += Printed("request    %016llx, (%d, %d) to (%d, %d)\n",
                  static_cast<unsigned long long>(deployed_->request_id),
                  deployed_->start_x, deployed_->start_y, deployed_->goal_x,
                  deployed_->goal_y);
  text += Printed("deployed   %s%s%s, route %lld, heard %.1f s ago\n",
                  ModeName(deployed_->mode),
                  deployed_->source.empty() ? "" : " of ",
                  Printable(deployed_->source, 63).c_str(),
                  static_cast<long long>(deployed_->route_seq),
                  Seconds(now - deployed_at_));
  if (deployed_->mode == deployed_t::MODE_BASELINE ||
      deployed_->mode == deployed_t::MODE_CANDIDATE) {
    text += Printed(
        "cost       %.3f; baseline %.3f, saving %.2f %%\n",
        deployed_->deployed_cost, deployed_->baseline_cost,
        SavingPercent(deployed_->baseline_cost, deployed_->deployed_cost));
  }
  return text;
}

std::string MonitorNode::VerdictLines() const {
  std::string text = "\nverdicts, newest first\n";
  for (const verdict_t& verdict : verdicts_) {
    const auto code = static_cast<verifier::Code>(verdict.code);
    text += Printed("  %-20s %-16s cost %.3f against %.3f, judged in %lld us\n",
                    Printable(verdict.subject == verdict_t::SUBJECT_BASELINE
                                  ? "(the baseline)"
                                  : verdict.advisor,
                              20)
                        .c_str(),
                    std::string(verifier::CodeName(code)).c_str(),
                    verdict.candidate_cost, verdict.cost_to_beat,
                    static_cast<long long>(verdict.t_det_us));
  }
  return text + EarlierVerdictLines();
}

// A verdict is said once. Of those from before this view only that is known
// which is repeated: the route they left deployed, and the gate's counts.
std::string MonitorNode::EarlierVerdictLines() const {
  std::string text;
  const bool of_this_view =
      deployed_ &&
      std::any_of(verdicts_.begin(), verdicts_.end(),
                  [this](const verdict_t& verdict) {
                    return verdict.session == deployed_->session &&
                           verdict.code == verdict_t::CODE_ACCEPTED;
                  });
  if (deployed_ && deployed_->mode == deployed_t::MODE_CANDIDATE &&
      !of_this_view) {
    text += Printed(
        "  %-20s accepted before this view began: attempt %lld, "
        "cost %.3f\n",
        Printable(deployed_->source, 20).c_str(),
        static_cast<long long>(deployed_->source_attempt),
        deployed_->deployed_cost);
  }
  for (const auto& [key, process] : processes_) {
    const auto judged = CounterOf(process.status, "judged");
    const auto accepted = CounterOf(process.status, "accepted");
    if (!judged || !accepted) continue;
    text += Printed("  %s has judged %lld since its start and accepted %lld\n",
                    Printable(process.status.status_name, 20).c_str(),
                    static_cast<long long>(*judged),
                    static_cast<long long>(*accepted));
  }
  if (verdicts_.empty() && text.empty()) {
    text = "  none heard since this view began\n";
  }
  return text;
}

std::string MonitorNode::ProcessLines(bus::Time now) const {
  std::string text = "\nprocesses\n";
  if (processes_.empty()) text += "  none heard\n";
  for (const auto& [key, process] : processes_) {
    const status_t& status = process.status;
    const bus::Duration age = now - process.heard_at;
    text += Printed("  %-20s %8d  %s\n",
                    Printable(status.status_name, 20).c_str(), status.pid,
                    age > kSilent
                        ? Printed("SILENT for %.0f s", Seconds(age)).c_str()
                        : Printable(status.state, 60).c_str());
    text += ModelLine(status);
    if (!status.last_error.empty()) {
      text += "      last error: " + Printable(status.last_error, 160) + "\n";
    }
  }
  return text;
}

}  // namespace terra::cli

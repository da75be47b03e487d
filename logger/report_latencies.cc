#include "logger/report_latencies.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <variant>

#include "logger/report_html.h"

namespace terra::logger {
namespace {

using terra_msg::verdict_t;

// The recorder hears two buses, so an answer may seem earlier than it was.
constexpr std::int64_t kSlackUs = 100'000;
// Where it is not known what passed: nobody waits longer for an answer.
constexpr std::int64_t kLongestUs = 3'600'000'000;

// When each baseline was first heard, by digest. Not those that the part began
// with, which were said before, nobody knows when.
std::map<std::int64_t, std::int64_t> BaselineTimes(
    const LogContents& contents) {
  std::map<std::int64_t, std::int64_t> times;
  for (const auto& [name, baseline] : contents.baselines) {
    const std::int64_t time_us = baseline.index < contents.state_end
                                     ? std::numeric_limits<std::int64_t>::min()
                                     : baseline.time_us;
    const auto [at, added] = times.try_emplace(name.digest, time_us);
    at->second = std::min(at->second, time_us);
  }
  std::erase_if(times, [](const auto& entry) {
    return entry.second == std::numeric_limits<std::int64_t>::min();
  });
  return times;
}

// How long after `from_us` a time is, at least 0. Times of a log may be any
// numbers.
std::int64_t Between(std::int64_t from_us, std::int64_t to_us) {
  if (to_us <= from_us) return 0;
  std::int64_t passed = 0;
  return __builtin_sub_overflow(to_us, from_us, &passed)
             ? std::numeric_limits<std::int64_t>::max()
             : passed;
}

// Collects what each sender says of himself.
class Claimants {
 public:
  // In the order of the log.
  void Add(const std::string& who, std::int64_t said_us,
           std::int64_t passed_us) {
    Claims* claims = FindOrAdd(who);
    if (claims == nullptr) return;
    ++claims->all;
    if (said_us < 0 || said_us - kSlackUs > passed_us) {
      ++claims->impossible;
    } else {
      claims->possible.seconds.push_back(1e-6 * static_cast<double>(said_us));
    }
  }

  void MoveTo(RunLatencies& latencies) {
    for (Claims& claims : all_) {
      if (claims.impossible > 0) {
        latencies.impossible.push_back(
            {claims.possible.name, claims.impossible, claims.all});
      }
      if (!claims.possible.seconds.empty()) {
        latencies.claimed.push_back(std::move(claims.possible));
      }
    }
    latencies.left_out += left_out_.size();
  }

 private:
  struct Claims {
    Latency possible;
    std::int64_t impossible = 0;
    std::int64_t all = 0;
  };
  static constexpr std::size_t kMaxCounted = 10'000;

  Claims* FindOrAdd(const std::string& who) {
    for (Claims& claims : all_) {
      if (claims.possible.name == who) return &claims;
    }
    if (all_.size() >= RunLatencies::kMaxClaimants) {
      if (left_out_.size() < kMaxCounted) left_out_[who] = true;
      return nullptr;
    }
    return &all_.emplace_back(Claims{{who, {}}, 0, 0});
  }

  std::vector<Claims> all_;
  std::map<std::string, bool> left_out_;
};

void AddAdvisors(const LogContents& contents, RunLatencies& latencies) {
  std::vector<const Logged<terra_msg::advice_t>*> in_order;
  for (const auto& [name, advice] : contents.advice) {
    in_order.push_back(&advice.front());
  }
  std::sort(in_order.begin(), in_order.end(), [](const auto* a, const auto* b) {
    return a->index < b->index;
  });
  const auto baseline_times = BaselineTimes(contents);
  Claimants advisors;
  for (const auto* advice : in_order) {
    if (advice->message.t_llm_us == 0) continue;  // No model was asked.
    const auto asked = baseline_times.find(advice->message.baseline_digest);
    const bool known =
        asked != baseline_times.end() && advice->index >= contents.state_end;
    advisors.Add("T_llm of " + advice->message.advisor,
                 advice->message.t_llm_us,
                 known ? Between(asked->second, advice->time_us) : kLongestUs);
  }
  advisors.MoveTo(latencies);
}

void AddGates(const LogContents& contents, RunLatencies& latencies) {
  Claimants gates;
  for (const auto* logged : contents.DecisionsInOrder()) {
    const auto* verdict = std::get_if<verdict_t>(&logged->message);
    if (verdict == nullptr) continue;
    const std::string who =
        contents.decisions.size() == 1
            ? std::string("T_det of the gate")
            : "T_det of gate " + std::to_string(verdict->session);
    gates.Add(who, verdict->t_det_us,
              logged->index < contents.state_end
                  ? kLongestUs
                  : Between(contents.first_us, logged->time_us));
  }
  gates.MoveTo(latencies);
}

}  // namespace

RunLatencies LatenciesOf(const LogContents& contents,
                         const std::vector<RequestStory>& stories) {
  Latency asked{"request to baseline deployed", {}};
  Latency baseline{"baseline to deployed", {}};
  Latency refined{"request to refined route", {}};
  const auto add = [](Latency& latency, std::int64_t from, std::int64_t to) {
    if (from != 0 && to != 0) {
      latency.seconds.push_back(std::max(0.0, SecondsBetween(from, to)));
    }
  };
  for (const RequestStory& story : stories) {
    add(asked, story.asked_us, story.baseline_deployed_us);
    add(baseline, story.baseline_us, story.baseline_deployed_us);
    add(refined, story.asked_us, story.refined_us);
  }
  RunLatencies latencies;
  latencies.measured = {asked, baseline, refined};
  AddAdvisors(contents, latencies);
  AddGates(contents, latencies);
  return latencies;
}

std::string LatencySection(const RunLatencies& latencies) {
  std::string html =
      LatencyChart(latencies.measured) +
      "<p class=\"note\">Between events: as the recorder heard them, on its "
      "own clock.</p>\n" +
      LatencyChart(latencies.claimed) +
      "<p class=\"note\">What each sender says of himself; nobody can check "
      "it.</p>\n";
  for (const ImpossibleClaims& claims : latencies.impossible) {
    html += "<p class=\"bad\">" + Escape(claims.who) +
            Format(
                ": %lld of %lld figures left out, negative or longer than the "
                "time that passed. They are not true, or come from a recording "
                "that is played again.</p>\n",
                static_cast<long long>(claims.impossible),
                static_cast<long long>(claims.all));
  }
  if (latencies.left_out > 0) {
    html += Format("<p class=\"note\">%zu more senders are not shown.</p>\n",
                   latencies.left_out);
  }
  return html;
}

}  // namespace terra::logger

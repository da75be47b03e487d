#include "chaos/chaos_node.h"

#include <algorithm>
#include <iostream>
#include <sstream>

#include "verifier/verify.h"

namespace terra::chaos {
namespace {

using terra_msg::baseline_t;
using terra_msg::verdict_t;

constexpr std::size_t kAttemptsRemembered = 100'000;
// Between two looks at the bus when flooding.
constexpr int kBurst = 64;

bus::Duration PeriodOf(double rate) {
  return std::chrono::duration_cast<bus::Duration>(
      std::chrono::duration<double>(1.0 / rate));
}

}  // namespace

ChaosNode::ChaosNode(ChaosOptions options, Attacker attacker, bus::Outbox& out,
                     Send send)
    : options_(std::move(options)),
      attacker_(std::move(attacker)),
      send_(std::move(send)),
      map_(out),
      session_(out.session()),
      pace_(PeriodOf(options_.rate)) {
  for (const Fault* fault : options_.faults) tallies_[fault->name];
  Listen<terra_msg::map_header_t>([this](const auto& message, bus::Time now) {
    OverhearDeployed(message);
    learned_ = !map_.OnHeader(message, now) && learned_;
  });
  Listen<terra_msg::map_tile_t>([this](const auto& message, bus::Time now) {
    learned_ = !map_.OnTiles(message, now) && learned_;
  });
  Listen<baseline_t>([this](const baseline_t& message, bus::Time) {
    if (message.status != baseline_t::STATUS_OK ||
        message.waypoint_x.size() < 2 ||
        message.waypoint_x.size() > bus::kMaxWaypoints) {
      return;
    }
    OverhearDeployed(message);
    learned_ = learned_ && message.baseline_digest == baseline_.baseline_digest;
    baseline_ = message;
  });
  Listen<verdict_t>([this](const verdict_t& message, bus::Time) {
    OverhearDeployed(message);
    OnVerdict(message);
  });
  ListenOnly<terra_msg::plan_request_t>();
  ListenOnly<terra_msg::deployed_t>();
  ListenOnly<terra_msg::pose_t>();
  ListenOnly<terra_msg::status_t>();
}

template <typename T>
void ChaosNode::OverhearDeployed(const T& message) {
  attacker_.OverhearDeployed(
      {bus::MessageTraits<T>::kChannel, bus::Encode(message)});
}

template <typename T>
void ChaosNode::ListenOnly() {
  Listen<T>([this](const T& message, bus::Time) {
    OverhearDeployed(message);
  });
}

void ChaosNode::Overhear(std::span<const std::uint8_t> payload) {
  const Result<terra_msg::advice_t> advice =
      bus::Decode<terra_msg::advice_t>(payload);
  if (advice && advice->session != session_) attacker_.Overhear(payload);
}

void ChaosNode::OnVerdict(const verdict_t& verdict) {
  const std::int64_t first =
      attacker_.last_attempt() -
      static_cast<std::int64_t>(fault_of_attempt_.size()) + 1;
  const std::int64_t at = verdict.attempt - first;
  if (verdict.advisor_session != session_ || at < 0 ||
      at >= static_cast<std::int64_t>(fault_of_attempt_.size())) {
    return;
  }
  const Fault* fault = fault_of_attempt_[static_cast<std::size_t>(at)];
  ++tallies_[fault->name].verdicts[verdict.code];
}

void ChaosNode::Misbehave() {
  const int last = static_cast<int>(options_.faults.size()) - 1;
  const Fault* fault =
      options_.faults[static_cast<std::size_t>(attacker_.Pick(0, last))];
  if (fault->needs_baseline && !attacker_.has_baseline()) return;
  attacker_.SetTime(bus::UnixMicroseconds());
  const std::int64_t attempts = attacker_.last_attempt();
  Tally& tally = tallies_[fault->name];
  const std::vector<Datagram> datagrams = fault->make(attacker_);
  for (std::int64_t i = attempts; i < attacker_.last_attempt(); ++i) {
    fault_of_attempt_.push_back(fault);
    if (fault_of_attempt_.size() > kAttemptsRemembered) {
      fault_of_attempt_.pop_front();
    }
  }
  if (datagrams.empty()) return;
  for (const Datagram& datagram : datagrams) {
    ++(send_(datagram) ? tally.datagrams : tally.send_failed);
  }
  ++tally.misdeeds;
  ++misdeeds_;
}

bus::Time ChaosNode::Advance(bus::Time now) {
  if (end_ == bus::kNever && options_.duration_s > 0) {
    end_ = now + std::chrono::duration_cast<bus::Duration>(
                     std::chrono::duration<double>(options_.duration_s));
  }
  const bus::Time ask = map_.Advance(now);
  if (!learned_ && map_.map() && baseline_.map_id == map_.map_id()) {
    attacker_.Learn(baseline_, map_.map());
    learned_ = true;
  }
  const auto enough = [this] {
    return options_.count > 0 && misdeeds_ >= options_.count;
  };
  if (options_.flood) {
    for (int i = 0; i < kBurst && !enough(); ++i) Misbehave();
  } else if (!enough() && pace_.Due(now)) {
    Misbehave();
  }
  done_ = now >= end_ || enough();
  const bool waits = options_.flood && misdeeds_ == 0;
  const bus::Time next =
      options_.flood && !waits
          ? now
          : (waits ? now + std::chrono::milliseconds(20) : pace_.next());
  return std::min({ask, next, end_});
}

std::string ChaosNode::state() const {
  return attacker_.has_baseline() ? "ready, misbehaving"
                                  : "ready, no baseline yet";
}

void ChaosNode::AddCounters(bus::Counters& counters) const {
  Node::AddCounters(counters);
  counters.emplace_back("misdeeds", misdeeds_);
  for (const auto& [name, tally] : tallies_) {
    counters.emplace_back("sent " + std::string(name), tally.datagrams);
  }
}

std::string ChaosNode::Report() const {
  std::ostringstream report;
  for (const auto& [name, tally] : tallies_) {
    report << name << ": " << tally.misdeeds << " misdeeds, " << tally.datagrams
           << " datagrams";
    if (tally.send_failed > 0)
      report << ", " << tally.send_failed << " refused";
    for (const auto& [code, times] : tally.verdicts) {
      report << ", " << times << ' '
             << verifier::CodeName(static_cast<verifier::Code>(code));
    }
    const Fault* fault = FindFault(name);
    if (fault->outcome == Outcome::kMustNotPass &&
        tally.verdicts.count(verdict_t::CODE_ACCEPTED) != 0) {
      report << "  <-- THE GATE ACCEPTED A LIE";
    }
    report << '\n';
  }
  return report.str();
}

void ChaosNode::Finish() {
  std::cout << Report() << std::flush;
}

int ChaosNode::exit_code() const {
  return std::any_of(tallies_.begin(), tallies_.end(), [](const auto& row) {
    return FindFault(row.first)->outcome == Outcome::kMustNotPass &&
           row.second.verdicts.count(verdict_t::CODE_ACCEPTED) != 0;
  });
}

}  // namespace terra::chaos

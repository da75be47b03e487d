#include "logger/audit_session.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "bus/codec.h"
#include "terrain/digest.h"
#include "verifier/gate_codec.h"

namespace terra::logger {
namespace {

using terra_msg::deployed_t;
using terra_msg::verdict_t;
using verifier::AdviceEvent;
using verifier::AdviceKind;

// The gate's only option that decides anything, from its CONFIG.
double MarginIn(const std::string& config) {
  constexpr std::string_view kKey = "margin=";
  std::size_t at = config.find(kKey);
  while (at != std::string::npos && at > 0 && config[at - 1] != '\n') {
    at = config.find(kKey, at + 1);
  }
  return at == std::string::npos
             ? 0.0
             : std::strtod(config.c_str() + at + kKey.size(), nullptr);
}

std::string Missing(const char* what, std::int64_t name) {
  return std::string("the log does not hold ") + what + " " +
         std::to_string(name);
}

bool IsStale(std::int16_t code) {
  return code == verdict_t::CODE_STALE_REQUEST ||
         code == verdict_t::CODE_STALE_MAP ||
         code == verdict_t::CODE_STALE_BASELINE;
}

// The advice that makes a gate deploy what was deployed.
AdviceEvent AdviceFor(const deployed_t& deployed) {
  AdviceEvent event;
  event.session = deployed.source_session;
  event.advisor = deployed.source;
  event.attempt = deployed.source_attempt;
  event.candidate = deployed.source_candidate;
  event.request_id = deployed.request_id;
  event.map_id = deployed.map_id;
  event.baseline_digest = deployed.baseline_digest;
  event.anchor.cell = Cell{deployed.start_x, deployed.start_y};
  event.kind = AdviceKind::kPropose;
  event.waypoints = bus::WaypointsOf(deployed);
  return event;
}

}  // namespace

SessionAudit::SessionAudit(LogContents& contents, std::int64_t session,
                           Audit& audit)
    : contents_(contents), session_(session), audit_(audit) {
  options_.session = session;
  const auto config = contents_.configs.find(session);
  if (config != contents_.configs.end()) {
    options_.margin = MarginIn(config->second.config_text);
  }
}

void SessionAudit::Run() {
  std::int64_t last = 0;
  for (const auto& [decision, logged] : contents_.decisions.at(session_)) {
    if (decision == 1) {
      Start();
    } else if (last != 0 && decision != last + 1) {
      Fail(Finding::Kind::kGap, decision,
           "decisions " + std::to_string(last + 1) + " to " +
               std::to_string(decision - 1) + " are not in the log");
      gate_.reset();
    }
    last = decision;
    Check(logged);
  }
}

void SessionAudit::Start() {
  gate_ = std::make_unique<verifier::Gate>(options_);
  decided_.clear();
  decision_offset_ = 0;
  route_seq_offset_ = 0;
  map_id_ = 0;
  baseline_digest_ = 0;
  poses_played_ = 0;
}

void SessionAudit::Check(const Logged<Decided>& logged) {
  const auto* deployed = std::get_if<deployed_t>(&logged.message);
  const std::int64_t decision =
      deployed != nullptr ? deployed->decision
                          : std::get<verdict_t>(logged.message).decision;
  if (!gate_) {
    if (deployed == nullptr) {
      Fail(Finding::Kind::kMissingInput, decision,
           "no DEPLOYED before this verdict says what was in force");
    } else if (Anchor(*deployed)) {
      ++audit_.anchors;
    } else {
      gate_.reset();
    }
    return;
  }
  if (decided_.empty()) {
    const std::string fault = Cause(logged);
    if (!fault.empty()) {
      Fail(Finding::Kind::kMissingInput, decision, fault);
      gate_.reset();
      return;
    }
  }
  if (decided_.empty()) {
    Fail(Finding::Kind::kMismatch, decision,
         "the gate decides nothing on what it names");
    gate_.reset();
    return;
  }
  Compare(logged.message);
}

void SessionAudit::Compare(const Decided& logged) {
  const verifier::Decision made = std::move(decided_.front());
  decided_.pop_front();
  std::vector<std::uint8_t> bytes;
  std::int64_t decision = 0;
  if (const auto* verdict = std::get_if<verifier::Verdict>(&made)) {
    verifier::Verdict numbered = *verdict;
    decision = numbered.decision += decision_offset_;
    numbered.route_seq_before += route_seq_offset_;
    if (numbered.anchor.session == session_) {
      numbered.anchor.route_seq += route_seq_offset_;
    }
    bytes = Essence(verifier::ToMessage(numbered, 0));
  } else {
    verifier::Deployed numbered = std::get<verifier::Deployed>(made);
    decision = numbered.decision += decision_offset_;
    numbered.route_seq += route_seq_offset_;
    bytes = Essence(verifier::ToMessage(numbered));
  }
  const bool is_verdict = std::holds_alternative<verdict_t>(logged);
  if (bytes == Essence(logged)) {
    ++(is_verdict ? audit_.verdicts : audit_.deployed);
    return;
  }
  Fail(Finding::Kind::kMismatch, decision,
       std::string("the gate decides otherwise than ") +
           (is_verdict ? "VERDICT" : "DEPLOYED") + " says");
  gate_.reset();
}

// ---- Where the log begins ----

bool SessionAudit::Anchor(const deployed_t& deployed) {
  Start();
  const std::string fault = PlayState(deployed);
  if (!fault.empty()) {
    Fail(Finding::Kind::kMissingInput, deployed.decision, fault);
    return false;
  }
  verifier::Deployed state = gate_->deployed();
  decision_offset_ = deployed.decision - state.decision;
  if (!decided_.empty()) {
    // The last decision may be a verdict, which counts too.
    decision_offset_ = deployed.decision - std::visit(
                                               [](const auto& one) {
                                                 return one.decision;
                                               },
                                               decided_.back());
  }
  route_seq_offset_ = deployed.route_seq - state.route_seq;
  decided_.clear();
  // What led to the state is not known, only that it is one.
  state.decision = deployed.decision;
  state.route_seq = deployed.route_seq;
  state.cause = verifier::Cause{deployed.cause};
  if (deployed.mode == deployed_t::MODE_NONE ||
      deployed.mode == deployed_t::MODE_HOLD) {
    state.mode = verifier::Mode{deployed.mode};
    state.map_id = deployed.map_id;
  }
  state.baseline_digest = deployed.baseline_digest;
  if (Essence(verifier::ToMessage(state)) == Essence(deployed)) return true;
  Fail(Finding::Kind::kMismatch, deployed.decision,
       "route or costs are not what its inputs give");
  return false;
}

// Brings a fresh gate to the state that a DEPLOYED tells.
std::string SessionAudit::PlayState(const deployed_t& deployed) {
  PlayReplaced(deployed);
  std::string fault;
  if (deployed.map_id != 0) fault = PlayMap(deployed.map_id);
  if (!fault.empty()) return fault;
  Play(verifier::RequestEvent{deployed.request_id, false,
                              Cell{deployed.start_x, deployed.start_y},
                              Cell{deployed.goal_x, deployed.goal_y}});
  if (deployed.cause == deployed_t::CAUSE_CANCELLED) {
    Play(verifier::RequestEvent{deployed.request_id, true, {}, {}});
  }
  if (deployed.baseline_digest == 0) return {};
  const auto found = contents_.baselines.find(deployed.baseline_digest);
  if (found == contents_.baselines.end()) {
    return Missing("baseline", deployed.baseline_digest);
  }
  verifier::BaselineEvent baseline = verifier::ToEvent(found->second.message);
  if (baseline.map_id != deployed.map_id) {
    // Made for the map before; the gate went on with its route.
    baseline.map_id = deployed.map_id;
    baseline.baseline_digest = BaselineDigest(
        baseline.request_id, baseline.map_id, baseline.waypoints);
  }
  baseline_digest_ = baseline.baseline_digest;
  Play(baseline);
  if (deployed.mode == deployed_t::MODE_CANDIDATE) {
    AdviceEvent advice = AdviceFor(deployed);
    advice.baseline_digest = baseline.baseline_digest;
    Play(advice);
  }
  return {};
}

// What was in force before counts by its name only: advice for it is stale.
void SessionAudit::PlayReplaced(const deployed_t& deployed) {
  const bus::MapPtr map = contents_.maps.Find(deployed.map_id);
  const auto play_map = [&](std::int64_t id) {
    if (map && id != 0 && id != deployed.map_id) {
      Play(verifier::MapEvent{std::shared_ptr<const TerrainMap>(map, &map->map),
                              id});
    }
  };
  const auto play_request = [&](std::int64_t id) {
    if (id != deployed.request_id) {
      Play(verifier::RequestEvent{id, false, {}, {}});
    }
  };
  for (const std::int64_t id : contents_.maps.ids()) play_map(id);
  for (const auto& [name, advice] : contents_.advice) play_map(name.map_id);
  for (const auto& [id, request] : contents_.requests) {
    if (request.message.utime <= deployed.utime) play_request(id);
  }
  for (const auto& [name, advice] : contents_.advice) {
    if (advice.message.utime <= deployed.utime) play_request(name.request_id);
  }
}

// ---- What a decision was made from ----

std::string SessionAudit::Cause(const Logged<Decided>& logged) {
  const auto* verdict = std::get_if<verdict_t>(&logged.message);
  return verdict != nullptr ? CauseOf(*verdict, logged.index)
                            : CauseOf(std::get<deployed_t>(logged.message));
}

std::string SessionAudit::CauseOf(const verdict_t& verdict,
                                  std::int64_t index) {
  if (verdict.subject == verdict_t::SUBJECT_BASELINE) {
    std::string fault = PlayMap(verdict.map_id);
    if (fault.empty() && decided_.empty()) {
      fault = PlayBaseline(verdict.baseline_digest);
    }
    return fault;
  }
  std::string fault;
  if (verdict.code == verdict_t::CODE_STALE_MAP) {
    fault = ReplaceMap(verdict.map_id);
  } else if (verdict.code == verdict_t::CODE_STALE_BASELINE) {
    fault = ReplaceBaseline(verdict.baseline_digest);
  } else if (!IsStale(verdict.code) &&
             verdict.request_id == gate_->deployed().request_id) {
    fault = PlayMap(verdict.map_id);
    if (fault.empty()) fault = PlayBaseline(verdict.baseline_digest);
  }
  if (verdict.code == verdict_t::CODE_LATE) PlayPoses(index);
  return fault.empty() && decided_.empty() ? PlayAdvice(verdict) : fault;
}

std::string SessionAudit::CauseOf(const deployed_t& deployed) {
  switch (deployed.cause) {
    case deployed_t::CAUSE_NEW_REQUEST:
    case deployed_t::CAUSE_CANCELLED: {
      const std::string fault = PlayMap(deployed.map_id);
      if (!fault.empty() || !decided_.empty()) return fault;
      return deployed.cause == deployed_t::CAUSE_CANCELLED
                 ? PlayCancel(deployed.request_id)
                 : PlayRequest(deployed.request_id);
    }
    case deployed_t::CAUSE_NO_ROUTE: {
      const std::string fault = PlayMap(deployed.map_id);
      return fault.empty() ? PlayNoRoute(deployed.request_id) : fault;
    }
    case deployed_t::CAUSE_NEW_BASELINE:
    case deployed_t::CAUSE_BASELINE_INVALID: {
      std::string fault = PlayMap(deployed.map_id);
      if (fault.empty() && decided_.empty()) {
        fault = PlayBaseline(deployed.baseline_digest);
      }
      return fault;
    }
    case deployed_t::CAUSE_MAP_UPDATE:
    case deployed_t::CAUSE_REVERT_BLOCKED:
    case deployed_t::CAUSE_REVERT_NOT_CHEAPER: {
      const auto held = contents_.baselines.find(deployed.baseline_digest);
      if (held != contents_.baselines.end() &&
          held->second.message.map_id == map_id_) {
        PlayBaseline(deployed.baseline_digest);
      }
      return PlayMap(deployed.map_id);
    }
    default:
      return "an upgrade that no verdict allowed";
  }
}

template <typename Event>
void SessionAudit::Play(const Event& event) {
  for (verifier::Decision& decision : gate_->On(event)) {
    decided_.push_back(std::move(decision));
  }
}

std::string SessionAudit::PlayAdvice(const verdict_t& verdict) {
  const AdviceName name = {verdict.request_id,      verdict.map_id,
                           verdict.baseline_digest, verdict.advisor_session,
                           verdict.attempt,         verdict.candidate};
  const auto found = contents_.advice.find(name);
  if (found == contents_.advice.end()) {
    return Missing("the advice, attempt", verdict.attempt);
  }
  AdviceEvent event = verifier::ToEvent(found->second.message);
  if (event.anchor.session == session_) {
    event.anchor.route_seq -= route_seq_offset_;
  }
  Play(event);
  return {};
}

std::string SessionAudit::PlayRequest(std::int64_t request_id) {
  const auto found = contents_.requests.find(request_id);
  if (found != contents_.requests.end()) {
    baseline_digest_ = 0;
    Play(verifier::ToEvent(found->second.message));
    return {};
  }
  // The gate may have it from the planner.
  for (const auto& [digest, baseline] : contents_.baselines) {
    const terra_msg::baseline_t& message = baseline.message;
    if (message.request_id != request_id) continue;
    baseline_digest_ = 0;
    Play(verifier::RequestEvent{request_id, false,
                                Cell{message.start_x, message.start_y},
                                Cell{message.goal_x, message.goal_y}});
    return {};
  }
  return Missing("request", request_id);
}

std::string SessionAudit::PlayCancel(std::int64_t request_id) {
  const auto found = contents_.cancels.find(request_id);
  if (found != contents_.cancels.end()) {
    Play(verifier::ToEvent(found->second.message));
    if (!decided_.empty()) return {};
  }
  for (const auto& baseline : contents_.other_baselines) {
    if (baseline.message.request_id == request_id &&
        baseline.message.status == terra_msg::baseline_t::STATUS_CANCELLED) {
      Play(verifier::ToEvent(baseline.message));
      if (!decided_.empty()) return {};
    }
  }
  return Missing("the end of request", request_id);
}

std::string SessionAudit::PlayMap(std::int64_t map_id) {
  if (map_id == map_id_ || map_id == 0) return {};
  const bus::MapPtr map = contents_.maps.Find(map_id);
  if (!map) return Missing("all of map", map_id);
  map_id_ = map_id;
  Play(verifier::MapEvent{std::shared_ptr<const TerrainMap>(map, &map->map),
                          map_id});
  return {};
}

std::string SessionAudit::PlayBaseline(std::int64_t digest) {
  if (digest == baseline_digest_) return {};
  const auto found = contents_.baselines.find(digest);
  if (found == contents_.baselines.end()) return Missing("baseline", digest);
  baseline_digest_ = digest;
  Play(verifier::ToEvent(found->second.message));
  return {};
}

std::string SessionAudit::PlayNoRoute(std::int64_t request_id) {
  for (const auto& baseline : contents_.other_baselines) {
    if (baseline.message.request_id != request_id ||
        baseline.message.map_id != map_id_ ||
        baseline.message.status == terra_msg::baseline_t::STATUS_CANCELLED) {
      continue;
    }
    baseline_digest_ = 0;
    Play(verifier::ToEvent(baseline.message));
    return {};
  }
  return Missing("a baseline without a route of request", request_id);
}

// The verdict says that this map was replaced, which may have gone unsaid.
std::string SessionAudit::ReplaceMap(std::int64_t map_id) {
  if (map_id != map_id_) return {};
  const std::vector<std::int64_t>& ids = contents_.maps.ids();
  const auto at = std::find(ids.begin(), ids.end(), map_id);
  if (at == ids.end() || at + 1 == ids.end()) {
    return "no map in the log comes after map " + std::to_string(map_id);
  }
  return PlayMap(*(at + 1));
}

std::string SessionAudit::ReplaceBaseline(std::int64_t digest) {
  const std::int64_t held = baseline_digest_;
  const std::string fault = PlayBaseline(digest);
  if (!fault.empty()) return fault;
  if (held != digest && held != 0) return PlayBaseline(held);
  const std::int64_t request_id = gate_->deployed().request_id;
  const auto old = contents_.baselines.find(digest);
  const Logged<terra_msg::baseline_t>* next = nullptr;
  for (const auto& [other, baseline] : contents_.baselines) {
    if (baseline.message.request_id == request_id &&
        baseline.message.map_id == map_id_ &&
        baseline.index > old->second.index &&
        (next == nullptr || baseline.index < next->index)) {
      next = &baseline;
    }
  }
  return next != nullptr ? PlayBaseline(next->message.baseline_digest)
                         : PlayNoRoute(request_id);
}

void SessionAudit::PlayPoses(std::int64_t before_index) {
  while (poses_played_ < contents_.poses.size() &&
         contents_.poses[poses_played_].index < before_index) {
    verifier::PoseEvent event =
        verifier::ToEvent(contents_.poses[poses_played_].message);
    event.route_seq -= route_seq_offset_;
    Play(event);
    ++poses_played_;
  }
}

void SessionAudit::Fail(Finding::Kind kind, std::int64_t decision,
                        std::string what) {
  audit_.Add({kind, session_, decision, std::move(what)});
}

}  // namespace terra::logger

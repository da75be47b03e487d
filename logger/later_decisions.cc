#include "logger/later_decisions.h"

namespace terra::logger {

using terra_msg::deployed_t;
using terra_msg::verdict_t;

bool IsStale(const verdict_t& verdict) {
  return verdict.code == verdict_t::CODE_STALE_REQUEST ||
         verdict.code == verdict_t::CODE_STALE_MAP ||
         verdict.code == verdict_t::CODE_STALE_BASELINE;
}

// Visits decisions in order until the visitor returns true.
template <typename Visit>
void LaterDecisions::ForEachFrom(std::int64_t decision, Visit visit) const {
  int seen = 0;
  for (auto at = decisions_.lower_bound(decision);
       at != decisions_.end() && seen < kHorizon; ++at, ++seen) {
    if (std::visit(visit, at->second.message)) return;
  }
}

namespace {

// For visitors that tell the two kinds of decision apart.
template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

void AddReplaced(const verdict_t& verdict, LaterDecisions::Replaced& replaced) {
  // Advice that cannot be read gets that code whatever its key.
  const bool any_key = verdict.code == verdict_t::CODE_MALFORMED_MESSAGE;
  if (any_key || verdict.code == verdict_t::CODE_STALE_REQUEST) {
    replaced.requests.insert(verdict.request_id);
  }
  if (any_key || verdict.code == verdict_t::CODE_STALE_MAP) {
    replaced.maps.insert(verdict.map_id);
  }
  if (any_key || verdict.code == verdict_t::CODE_STALE_BASELINE) {
    replaced.baselines.insert(verdict.baseline_digest);
  }
}

}  // namespace

std::int64_t LaterDecisions::PlannerOf(std::int64_t digest,
                                       std::int64_t decision) const {
  std::int64_t session = 0;
  ForEachFrom(decision,
              Overloaded{[&](const deployed_t& deployed) {
                           if (deployed.mode == deployed_t::MODE_BASELINE &&
                               deployed.baseline_digest == digest) {
                             session = deployed.source_session;
                           }
                           return session != 0;
                         },
                         [&](const verdict_t& verdict) {
                           if (verdict.subject == verdict_t::SUBJECT_BASELINE &&
                               verdict.baseline_digest == digest) {
                             session = verdict.advisor_session;
                           }
                           return session != 0;
                         }});
  return session;
}

std::int64_t LaterDecisions::BaselineAfter(std::int64_t digest,
                                           std::int64_t decision) const {
  std::int64_t next = 0;
  ForEachFrom(decision, Overloaded{[&](const deployed_t& deployed) {
                                     next = deployed.baseline_digest;
                                     return next != 0 && next != digest;
                                   },
                                   [&](const verdict_t& verdict) {
                                     if (IsStale(verdict)) return false;
                                     next = verdict.baseline_digest;
                                     return next != 0 && next != digest;
                                   }});
  return next != digest ? next : 0;
}

std::int64_t LaterDecisions::MapAfter(std::int64_t map_id,
                                      std::int64_t decision) const {
  std::int64_t next = 0;
  ForEachFrom(decision, Overloaded{[&](const deployed_t& deployed) {
                                     next = deployed.map_id;
                                     return next != 0 && next != map_id;
                                   },
                                   [&](const verdict_t& verdict) {
                                     if (IsStale(verdict)) return false;
                                     next = verdict.map_id;
                                     return next != 0 && next != map_id;
                                   }});
  return next != map_id ? next : 0;
}

LaterDecisions::Replaced LaterDecisions::ReplacedBefore(
    std::int64_t decision) const {
  Replaced replaced;
  std::set<std::int64_t> in_force_later;
  ForEachFrom(decision, Overloaded{[&](const deployed_t& deployed) {
                                     in_force_later.insert(deployed.request_id);
                                     return false;
                                   },
                                   [&](const verdict_t& verdict) {
                                     AddReplaced(verdict, replaced);
                                     return false;
                                   }});
  for (const std::int64_t id : in_force_later) replaced.requests.erase(id);
  return replaced;
}

}  // namespace terra::logger

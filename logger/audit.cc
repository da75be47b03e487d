#include "logger/audit.h"

#include <algorithm>
#include <utility>

#include "logger/audit_session.h"

namespace terra::logger {

const char* KindName(Finding::Kind kind) {
  switch (kind) {
    case Finding::Kind::kDamage:
      return "damage";
    case Finding::Kind::kConflict:
      return "conflict";
    case Finding::Kind::kGap:
      return "gap";
    case Finding::Kind::kMissingInput:
      return "missing input";
    case Finding::Kind::kMismatch:
      return "mismatch";
  }
  return "unknown";
}

void Audit::Add(Finding finding) {
  ++num_findings;
  if (findings.size() < kMaxFindings) findings.push_back(std::move(finding));
}

std::string Conclusion(const Audit& audit) {
  if (!audit.clean()) return std::to_string(audit.num_findings) + " findings";
  if (!audit.made_any_again()) return "nothing to audit";
  return audit.closed ? "clean" : "not closed";
}

namespace {

// A bound, so that sums of any numbers of a log do not overflow.
constexpr std::int64_t kMostTurnedAway = 1'000'000'000'000;

void AddDamage(const LogReader& reader, const SealChecker& seals,
               Audit& audit) {
  const auto add = [&audit](std::string what) {
    audit.Add({Finding::Kind::kDamage, 0, 0, std::move(what)});
  };
  for (const LogDamage& damage : reader.damage()) {
    add(std::to_string(damage.bytes) + " bytes at byte " +
        std::to_string(damage.offset) + " are no events");
  }
  if (!reader.read_error().empty()) add("read error: " + reader.read_error());
  if (!seals.sealed()) return;  // Another logger's.
  for (const SealChecker::Broken& broken : seals.broken()) {
    add("bytes " + std::to_string(broken.offset) + " to " +
        std::to_string(broken.offset + broken.bytes) + ": " + broken.reason);
  }
  if (seals.unsealed_bytes() > 0) {
    add("the last " + std::to_string(seals.unsealed_bytes()) +
        " bytes have no seal: written half, or changed");
  }
}

// The recorder tells in its heartbeat, which stands in its own log.
std::int64_t TurnedAway(const LogContents& contents, const SealChecker& seals) {
  if (!seals.header()) return 0;
  std::int64_t most = 0;
  for (const auto& [index, time_us, status] : contents.statuses) {
    if (status.session != seals.header()->session) continue;
    std::int64_t turned_away = 0;
    for (std::size_t i = 0; i < status.counter_name.size(); ++i) {
      const std::string& name = status.counter_name[i];
      if (name == "advice_over_limit" || name == "advice_lost_in_kernel") {
        turned_away += std::clamp<std::int64_t>(status.counter_value[i], 0,
                                                kMostTurnedAway);
      }
    }
    most = std::max(most, turned_away);
  }
  return most;
}

}  // namespace

Audit AuditContents(LogContents& contents, const LogReader& reader,
                    const SealChecker& seals) {
  Audit audit;
  AddDamage(reader, seals, audit);
  audit.closed = !seals.sealed() || seals.closed();
  // Under good seals the log is what was heard.
  const bool as_heard = seals.sealed() && audit.clean();
  if (as_heard) audit.advice_turned_away = TurnedAway(contents, seals);
  for (const Conflict& conflict : contents.conflicts) {
    if (conflict.of_gate || !as_heard) {
      audit.Add({Finding::Kind::kConflict, 0, 0, conflict.what});
    } else if (audit.notes.size() < Audit::kMaxFindings) {
      audit.notes.push_back(conflict.what);
    }
  }
  for (const auto& [session, decisions] : contents.decisions) {
    audit.sessions.push_back(session);
    SessionAudit(contents, session, audit).Run();
  }
  return audit;
}

Audit AuditLog(LogReader& reader) {
  SealChecker seals;
  LogContents contents = LogContents::Load(reader, seals);
  return AuditContents(contents, reader, seals);
}

}  // namespace terra::logger

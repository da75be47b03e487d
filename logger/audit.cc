#include "logger/audit.h"

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

}  // namespace

Audit AuditContents(LogContents& contents, const LogReader& reader,
                    const SealChecker& seals) {
  Audit audit;
  AddDamage(reader, seals, audit);
  audit.closed = !seals.sealed() || seals.closed();
  // Under good seals the log is what was heard.
  const bool as_heard = seals.sealed() && audit.clean();
  for (const Conflict& conflict : contents.conflicts) {
    if (conflict.of_gate || !as_heard) {
      audit.Add({Finding::Kind::kConflict, 0, 0, conflict.what});
    } else if (audit.notes.size() < Audit::kMaxFindings) {
      audit.notes.push_back(conflict.what);
    }
  }
  audit.sessions = contents.GateSessions();
  audit.has_journal = !contents.steps.empty();
  if (!audit.has_journal) return audit;
  for (const std::int64_t session : audit.sessions) {
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

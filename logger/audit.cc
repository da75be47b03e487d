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

Audit AuditDecisions(LogContents& contents) {
  Audit audit;
  for (const Conflict& conflict : contents.conflicts) {
    audit.Add({Finding::Kind::kConflict, 0, 0, conflict.what});
  }
  for (const auto& [session, decisions] : contents.decisions) {
    ++audit.sessions;
    SessionAudit(contents, session, audit).Run();
  }
  return audit;
}

void AddDamage(const LogReader& reader, const SealChecker& seals,
               Audit& audit) {
  for (const LogDamage& damage : reader.damage()) {
    audit.Add({Finding::Kind::kDamage, 0, 0,
               std::to_string(damage.bytes) + " bytes at byte " +
                   std::to_string(damage.offset) + " are no events"});
  }
  if (!seals.sealed()) return;  // Another logger's.
  for (const SealChecker::Broken& broken : seals.broken()) {
    audit.Add({Finding::Kind::kDamage, 0, 0,
               "bytes " + std::to_string(broken.offset) + " to " +
                   std::to_string(broken.offset + broken.bytes) + ": " +
                   broken.reason});
  }
}

Audit AuditLog(LogReader& reader) {
  SealChecker seals;
  LogContents contents = LogContents::Load(reader, seals);
  Audit audit = AuditDecisions(contents);
  AddDamage(reader, seals, audit);
  return audit;
}

}  // namespace terra::logger

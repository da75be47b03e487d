#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "logger/log_contents.h"

namespace terra::logger {

/// Something in a log that does not follow from the rest of it.
struct Finding {
  enum class Kind {
    kDamage,        ///< Bytes that are no events, or not what was written.
    kConflict,      ///< One name, two messages; what cannot be read.
    kGap,           ///< Steps or decisions of the gate that are not in the log.
    kMissingInput,  ///< A step names what the log does not hold.
    kMismatch,      ///< The gate does otherwise on the same step.
  };
  Kind kind = Kind::kDamage;
  std::int64_t session = 0;   ///< Of the gate, 0 for none.
  std::int64_t decision = 0;  ///< 0 for none.
  std::string what;
};

/// Returns "damage", "conflict", ...
const char* KindName(Finding::Kind kind);

/// The result of an audit.
struct Audit {
  static constexpr std::size_t kMaxFindings = 1'000;

  std::vector<std::int64_t> sessions;  ///< Of the gate.
  std::int64_t verdicts = 0;           ///< Made again, and the same.
  std::int64_t deployed = 0;           ///< Made again, and the same.
  std::int64_t steps = 0;  ///< Of the journal, played with the same outcome.
  /// Cores made from messages of the log, and proved by their digest, where the
  /// step before was not in the log or was not right.
  std::int64_t anchors = 0;
  /// What the gate's memories said of advice, taken as the journal has it,
  /// since the log does not hold all that they remembered.
  std::int64_t lookups_given = 0;
  /// Decisions of which the log does not hold the state before, the step or the
  /// message: before its beginning, at its end, or at a gap.
  std::int64_t unchecked = 0;
  /// Decisions on events that the gate left out of its journal to keep the
  /// journal within its rate, and that the log does not hold either.
  std::int64_t unrecorded = 0;
  /// Some gate wrote a journal in this log.
  bool has_journal = false;
  std::vector<Finding> findings;  ///< The first kMaxFindings.
  std::int64_t num_findings = 0;
  /// What other processes than the gate did wrong, if the log's seals show that
  /// it was they. The first kMaxFindings.
  std::vector<std::string> notes;

  /// Not one of our logs, or its last event is the mark that closes it. A log
  /// that was cut at a seal has only good bytes, and lacks its end.
  bool closed = true;

  bool clean() const { return num_findings == 0; }
  /// Some decision was made again. (A state that the log begins with is proved,
  /// and is no decision.)
  bool made_any_again() const { return verdicts + deployed > 0; }
  /// No finding, in a whole log, of which something was made again. Only this
  /// says that the gate was right.
  bool passed() const { return clean() && closed && made_any_again(); }
  void Add(Finding finding);
};

/// Returns "clean", "3 findings", "nothing to audit" or "not closed". Findings
/// are named first, then that there is nothing, then that the end is missing.
std::string Conclusion(const Audit& audit);

/// Plays the journals of a log's gates (docs/gate.md) to a gate of its own,
/// step by step, and compares decisions and cores with what the journals say,
/// and the decisions with VERDICT and DEPLOYED, byte for byte except utime,
/// session, seq and T_det; checks the log's seals.
///
/// The order in which the log has the messages does not matter: steps are taken
/// by their number. Each step is checked by itself, so one that is missing
/// costs only what it hides. A log without a journal is nothing to audit.
Audit AuditLog(LogReader& reader);

/// The same for a log that was read to its end.
Audit AuditContents(LogContents& contents, const LogReader& reader,
                    const SealChecker& seals);

}  // namespace terra::logger

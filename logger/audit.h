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
    kConflict,      ///< One name, two messages; a decision not readable.
    kGap,           ///< Decisions of the gate that are not in the log.
    kMissingInput,  ///< A decision names what the log does not hold.
    kMismatch,      ///< The gate decides otherwise on the same inputs.
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
  std::int64_t anchors = 0;  ///< Deployments taken as the state to go on from:
                             ///< route and costs made again, cause not known.
  std::int64_t unchecked = 0;  ///< Verdicts from before the first DEPLOYED.
  /// Datagrams of the advice bus that the recorder of a sealed log said it
  /// turned away. Gate and recorder each look at so many a second, in a flood
  /// not at the same ones.
  std::int64_t advice_turned_away = 0;
  /// Verdicts that could not be made again, since the recorder turned away what
  /// was judged. No findings; always 0 where it turned away nothing.
  std::int64_t unrecorded = 0;
  std::vector<Finding> findings;  ///< The first kMaxFindings.
  std::int64_t num_findings = 0;
  /// What other processes than the gate did wrong, if the log's seals show that
  /// it was they. The first kMaxFindings.
  std::vector<std::string> notes;

  /// Not one of our logs, or its last event is the mark that closes it. A log
  /// that was cut at a seal has only good bytes, and lacks its end.
  bool closed = true;

  bool clean() const { return num_findings == 0; }
  /// Some decision was made again.
  bool made_any_again() const { return verdicts + deployed + anchors > 0; }
  /// No finding, in a whole log, of which something was made again. Only this
  /// says that the gate was right.
  bool passed() const { return clean() && closed && made_any_again(); }
  void Add(Finding finding);
};

/// Returns "clean", "3 findings", "nothing to audit" or "not closed". Findings
/// are named first, then that there is nothing, then that the end is missing.
std::string Conclusion(const Audit& audit);

/// Makes every verdict and deployment of a log again, through the gate, from
/// the inputs that each names (docs/gate.md, invariant 6), and compares byte
/// for byte except utime, session, seq and T_det; checks the log's seals.
///
/// The order in which the log has them does not matter, since it is not the
/// order in which the gate heard them: decisions are taken by their number, and
/// each says what it was made from. Where the log begins in mid-session, or
/// lacks decisions, the next DEPLOYED is the state to go on from. A verdict on
/// advice that the recorder turned away is counted and passed over.
Audit AuditLog(LogReader& reader);

/// The same for a log that was read to its end.
Audit AuditContents(LogContents& contents, const LogReader& reader,
                    const SealChecker& seals);

}  // namespace terra::logger

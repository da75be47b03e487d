#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "terrain/anchor.h"
#include "terrain/cell.h"
#include "terrain/map.h"
#include "verifier/verify.h"

// What the gate takes and gives, as values: the message types of lcmtypes/
// without time stamps, sender counters and what the gate does not read.
namespace terra::verifier {

/// The gate repeats names in what it says, which has to fit a message: whoever
/// has a longer one is refused.
inline constexpr std::size_t kMaxNameBytes = 63;

// ---- Events: what the shell takes off the bus, lengths already checked. ----

/// The message that an event came with. Decides nothing; for the journal.
struct HeardMessage {
  std::int64_t session = 0;
  std::int64_t seq = 0;
  std::int64_t digest = 0;  ///< XXH3-64 of its encoded bytes.
};

/// A complete map came into force.
struct MapEvent {
  std::shared_ptr<const TerrainMap> map;
  std::int64_t map_id = 0;
};

/// PLAN_REQUEST.
struct RequestEvent {
  std::int64_t request_id = 0;
  bool cancel = false;
  Cell start;
  Cell goal;
};

/// BASELINE, of the planner session in force (the shell drops replaced ones).
struct BaselineEvent {
  std::int64_t session = 0;
  std::string planner;
  std::int64_t request_id = 0;
  Cell start;
  Cell goal;
  std::int64_t map_id = 0;
  bool cancelled = false;  ///< The planner carries a cancelled request on.
  bool has_route = false;  ///< Status OK; else the planner found none.
  std::int64_t baseline_digest = 0;
  Route waypoints;
};

/// What kind of answer an advisor has. Numbers are those of advice_t.
enum class AdviceKind : std::int8_t {
  kNone = 0,
  kRetain = 1,
  kPropose = 2,
  kMalformed = 3,
  kFailed = 4,
};

/// ADVICE.
struct AdviceEvent {
  std::int64_t session = 0;
  std::string advisor;
  std::int64_t attempt = 0;
  std::int32_t candidate = 0;
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  Anchor anchor;
  AdviceKind kind = AdviceKind::kNone;
  Route waypoints;
  HeardMessage heard;

  /// Repetitions of an advice are equal.
  friend bool operator==(const AdviceEvent& a, const AdviceEvent& b) {
    const auto said = [](const AdviceEvent& advice) {
      return std::tie(advice.session, advice.advisor, advice.attempt,
                      advice.candidate, advice.request_id, advice.map_id,
                      advice.baseline_digest, advice.anchor, advice.kind,
                      advice.waypoints);
    };
    return said(a) == said(b);
  }
};

/// POSE.
struct PoseEvent {
  Cell cell;
  /// The DEPLOYED that the robot follows.
  std::int64_t session = 0;
  std::int64_t route_seq = 0;
};

// ---- Decisions: what the shell publishes. ----

/// Numbers are those of deployed_t.
enum class Mode : std::int8_t {
  kNone = 0,
  kBaseline = 1,
  kCandidate = 2,
  kHold = 3,
};
enum class Cause : std::int8_t {
  kNone = 0,
  kNewRequest = 1,
  kNewBaseline = 2,
  kUpgrade = 3,
  kMapUpdate = 4,
  kRevertBlocked = 5,
  kRevertNotCheaper = 6,
  kBaselineInvalid = 7,
  kCancelled = 8,
  kNoRoute = 9,
};

/// DEPLOYED.
struct Deployed {
  std::int64_t decision = 0;
  std::int64_t route_seq = 0;
  std::int64_t request_id = 0;
  Cell start;
  Cell goal;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  Mode mode = Mode::kNone;
  Cause cause = Cause::kNone;
  std::string source;
  std::int64_t source_session = 0;
  std::int64_t source_attempt = 0;
  std::int32_t source_candidate = 0;
  Route waypoints;                     ///< Empty in modes none and hold.
  double cost = kImpassable;           ///< Recomputed here.
  double baseline_cost = kImpassable;  ///< Recomputed here.

  bool has_route() const {
    return mode == Mode::kBaseline || mode == Mode::kCandidate;
  }
  friend bool operator==(const Deployed&, const Deployed&) = default;
};

enum class Subject : std::int8_t { kAdvice = 1, kBaseline = 2 };

/// VERDICT.
struct Verdict {
  std::int64_t decision = 0;
  Subject subject = Subject::kAdvice;
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  Anchor anchor;
  std::string advisor;
  std::int64_t advisor_session = 0;
  std::int64_t attempt = 0;
  std::int32_t candidate = 0;
  Code code = Code::kNotChecked;
  double candidate_cost = kImpassable;  ///< From the anchor on.
  double baseline_cost = kImpassable;   ///< Of the whole baseline.
  double cost_to_beat = kImpassable;    ///< Deployed, from the anchor on.
  std::int64_t route_seq_before = 0;
  int fail_segment = -1;
  Cell fail_cell;

  friend bool operator==(const Verdict&, const Verdict&) = default;
};

/// What the gate's memories said of an event. Numbers are those of gate_step_t.
enum class Lookup : std::int8_t {
  kNone = 0,      ///< Nothing was looked up.
  kNew = 1,       ///< Another request; advice that was never judged.
  kRepeat = 2,    ///< Advice that has its verdict.
  kReplaced = 3,  ///< Advice for what was in force once.
  kUnknown = 4,   ///< Advice for what the gate does not know.
};

using Decision = std::variant<Verdict, Deployed>;
using Decisions = std::vector<Decision>;

}  // namespace terra::verifier
